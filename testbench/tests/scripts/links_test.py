#!/usr/bin/python3
"""Tests that every link in the documents leads to an existing file: links_test.py PROJECT_FOLDER."""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
wrong = []
found = 0
for room in ["README.md", "model", "cells", "pipeline", "scenes", "testbench", "scripts", "docs"]:
    top = root / room
    for document in [top] if top.is_file() else sorted(top.rglob("*.md")):
        for target in re.findall(r'(?:\]\(|src="|href=")([^)\s"#]+)', document.read_text()):
            if "://" not in target:
                found += 1
                if not (document.parent / target).exists():
                    wrong.append(f"{document}: {target} is not there")
print("\n".join(wrong) or f"{found} links")
sys.exit(bool(wrong) or found < 50)
