# One target, one command; CI calls the same. `make demo` sets everything up and renders a scene.
PYTHON ?= $(firstword $(foreach name,python3 python3.13 python3.12 python3.11,$(shell \
	$(name) -c 'import ensurepip, sys; sys.version_info >= (3, 11) and print("$(name)")' 2>/dev/null)))
RUN = .venv/bin

.PHONY: demo test setup format lint slow coverage warm bench gallery golden

demo: setup
	@mkdir -p out
	$(RUN)/artist render scenes/glass_sphere.toml -o out/demo.exr -o out/demo.png

test: setup
	$(RUN)/python -m pytest -m "not slow" -n auto --dist loadfile --no-loadscope-reorder

setup: .venv/installed

format: setup
	$(RUN)/ruff format .
	$(RUN)/ruff check --fix .

lint: setup
	$(RUN)/ruff format --check .
	$(RUN)/ruff check .

slow: setup
	$(RUN)/python -m pytest -m slow

coverage: setup
	$(RUN)/coverage run -m pytest -m "not slow"
	$(RUN)/coverage report --skip-covered

warm: setup
	$(RUN)/artist warm

bench: setup
	$(RUN)/python -m pip install --quiet --editable '.[bench]'
	$(RUN)/python -m benchmarks

gallery: setup
	$(RUN)/python scripts/make_mesh.py
	$(RUN)/python -m gallery

golden: setup
	$(RUN)/python tests/golden/rewrite.py

.venv/installed: pyproject.toml
	@"$(PYTHON)" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null || { \
		echo 'artist needs Python 3.11 or newer, with venv; say which: make PYTHON=/path/to/python' >&2; exit 1; }
	"$(PYTHON)" -m venv .venv
	$(RUN)/python -m pip install --quiet --editable '.[test]'
	@touch $@
