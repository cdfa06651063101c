"""What shows how good the renderer is: error against time, references, ablations, and reports of them."""
