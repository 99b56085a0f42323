"""What the tests of scripts say when something is not as it should be."""
import sys


def expect(condition, text):
    if not condition:
        sys.exit(f"expected: {text}")
