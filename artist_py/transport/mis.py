"""Multiple importance sampling (Veach and Guibas 1995)."""

from ..jit import function


@function
def balance(pdf, pdf_other):
    """Balance heuristic for two techniques with one sample each: the weight of the first."""
    return pdf / (pdf + pdf_other)
