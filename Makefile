# make demo    bakes a level, runs a mission on it, leaves trace, plot, film strip and page in out/
# make test    the tests, in two processes
# make check   what the continuous integration runs: linter, format, types, docs, tests
# make docs    the documentation as a site, in out/docs
PYTHON ?= python3
VENV := .venv
OUT := out

.PHONY: demo test check docs clean
export PYTHON

demo: $(VENV)/.installed
	@mkdir -p $(OUT)
	@echo "== baking the graph of the courtyard"
	@$(VENV)/bin/surefoot bake examples/levels/courtyard.obj --up z -o $(OUT)/courtyard.npz
	@echo "== running the mission"
	@$(VENV)/bin/surefoot run examples/missions/courtyard.yaml --out $(OUT)
	@echo "== look at $(OUT)/level.png and $(OUT)/film.png, and open $(OUT)/run.html in a browser"

test: $(VENV)/.installed-dev
	$(VENV)/bin/python -m pytest -n 2 --dist worksteal

check:
	bash .ci/run

docs: $(VENV)/.installed-dev
	$(VENV)/bin/python -m sphinx -q -W --keep-going docs $(OUT)/docs
	@echo "== open $(OUT)/docs/index.html"

$(VENV)/.installed: pyproject.toml
	@sh scripts/environment.sh $(VENV)
	@touch $@

$(VENV)/.installed-dev: pyproject.toml
	@sh scripts/environment.sh $(VENV) '[dev]'
	@touch $@ $(VENV)/.installed

clean:
	rm -rf $(VENV) $(OUT)
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
