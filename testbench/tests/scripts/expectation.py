"""The failure message that all tests of scripts use."""
import sys


def expect(condition, text):
    if not condition:
        sys.exit(f"expected: {text}")
