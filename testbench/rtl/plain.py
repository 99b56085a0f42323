#!/usr/bin/python3
"""The SystemVerilog cell in the part of the language that Yosys 0.23 reads: plain.py PACKAGE.sv FILE.sv ...

Yosys knows no import, casts to types, assignment patterns, or vectors of several dimensions, and structs in part.
Packages whose names begin with raycell_ become declarations outside of modules, casts to types those to a size, patterns
concatenations, structs and vectors of several dimensions flat vectors. What it prints is for Yosys alone: nothing else is
changed. Modules that import nothing and other packages should come first: their names are not to meet the declarations."""
import re
import sys

KEYWORDS = {"input", "output", "inout", "parameter", "localparam", "logic", "int", "bit", "function", "assign"}
PAIRS = {"(": ")", "[": "]", "{": "}"}
RANGE = re.compile(r"\s*\[")


class Type:
    """A vector of `width` bits, or a struct of fields, the first in the highest bits."""

    def __init__(self, width, signed=False, fields=None):
        self.width = width  # a number or an expression
        self.signed = signed
        self.fields = fields or {}

    def offset_of(self, field):
        names = list(self.fields)
        return total(self.fields[name].width for name in names[names.index(field) + 1:])


class Variable:
    """`unpacked` selects first, then the dimensions with `sizes`, then what `base` has."""

    def __init__(self, base, sizes, unpacked):
        self.base = base
        self.sizes = sizes
        self.unpacked = unpacked

    def width_behind(self, depth):
        width = self.base.width
        for size in self.sizes[depth:]:
            width = times(size, width)
        return width


def number(text):
    return int(text) if re.fullmatch(r"\d+", text) else None


def total(texts):
    known, rest = 0, []
    for text in texts:
        if number(text) is None:
            rest.append(text)
        else:
            known += int(text)
    if not rest:
        return str(known)
    return "(" + "+".join(rest + ([str(known)] if known else [])) + ")"


def times(a, b):
    if number(a) is not None and number(b) is not None:
        return str(int(a) * int(b))
    return b if a == "1" else a if b == "1" else f"({a}*{b})"


def end_of(text, start):
    """Behind the bracket that closes the one at `start`."""
    opens = text[start]
    depth = 0
    for at in range(start, len(text)):
        depth += (text[at] == opens) - (text[at] == PAIRS[opens])
        if depth == 0:
            return at + 1
    raise ValueError(f"'{text[start:start + 40]}': the bracket is not closed")


def split(text, at):
    """At each `at` that is in no bracket."""
    parts, depth, begin = [], 0, 0
    for i, c in enumerate(text):
        depth += (c in "([{") - (c in ")]}")
        if c == at and depth == 0 and ":" not in (text[i - 1:i], text[i + 1:i + 2]):
            parts.append(text[begin:i])
            begin = i + 1
    return parts + [text[begin:]]


def brackets(text, at):
    """The texts in the brackets that follow, and the place behind them."""
    found = []
    while match := RANGE.match(text, at):
        end = end_of(text, match.end() - 1)
        found.append(text[match.end():end - 1])
        at = end
    return found, at


def size_of(bounds):
    """Of high:low, where low is 0."""
    high = split(bounds, ":")[0].strip()
    if number(high) is not None:
        return str(int(high) + 1)
    less_one = re.fullmatch(r"(\w+)\s*-\s*1", high)
    return less_one.group(1) if less_one else f"(({high})+1)"


def value_of(text, constants):
    """Of a constant expression, or None."""
    parts = re.fullmatch(r"(.*?)\?(.*?):(.*)", text, re.DOTALL)
    if parts:
        condition = value_of(parts.group(1), constants)
        return None if condition is None else value_of(parts.group(2 if condition else 3), constants)
    text = re.sub(r"\$clog2\(", "clog2(", text)
    names = set(re.findall(r"(?<![\w'])[A-Za-z_]\w*", text)) - {"clog2"}
    if not names <= set(constants) or not re.fullmatch(r"[\w\s+*/()<>-]+", text):
        return None
    known = {"__builtins__": {}, "clog2": lambda value: (value - 1).bit_length(), **constants}
    return int(eval(text.replace("/", "//"), known))  # pylint: disable=eval-used


def with_values(text, constants):
    """A package whose integers are numbers; Yosys doesn't find all those that follow from others."""

    def number_of(match):
        value = value_of(match.group(2), constants)
        if value is None:
            return match.group(0)
        constants[match.group(1)] = value
        return f"{match.group(1)} = {value}"

    def integers(match):
        return re.sub(r"(\w+)\s*=\s*([^,;]+)", number_of, match.group(0))

    text = re.sub(r"\blocalparam int\b[^;]*;", integers, text)
    return re.sub(r"\[([^\[\]:]+):0\]", lambda match: f"[{match.group(1)}:0]" if value_of(match.group(1), constants) is None
                  else f"[{value_of(match.group(1), constants)}:0]", text)


def without_packages(text):
    text = re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.DOTALL)
    text = re.sub(r"\bpackage raycell_\w+;(.*?)\bendpackage\b", r"\1", text, flags=re.DOTALL)
    text = re.sub(r"^\s*import \w+::\*;\s*$", "", text, flags=re.MULTILINE)
    text = re.sub(r"\+\+(\w+)\)", r"\1++)", text)
    # It mixes no parts that are written at a place to be computed with others in one assignment.
    text = re.sub(r"\{(\w+(?:, \w+)+)\} <= '0;", lambda match: "begin " + " ".join(
        f"{name} <= '0;" for name in match.group(1).split(", ")) + " end", text)
    return re.sub(r"\b(raycell_\w+)::", "", text)


def typed(text, at, types):
    """The type at `at`: base, sizes of the dimensions before its own, and the place behind; or None."""
    match = re.compile(r"(\w+)(\s+signed\b)?").match(text, at)
    if not match:
        return None
    name = match.group(1)
    if name not in types and name not in ("logic", "bit"):
        return None
    ranges, end = brackets(text, match.end())
    sizes = [size_of(bounds) for bounds in ranges]
    if name in types:
        return types[name], sizes, end
    own = sizes.pop() if sizes else "1"
    return Type(own, bool(match.group(2))), sizes, end


def typedefs(text, types):
    """Takes the types out of a text into `types`."""
    struct = re.compile(r"\btypedef struct packed \{(.*?)\}\s*(\w+);|\btypedef\s+(.*?)\s+(\w+);", re.DOTALL)

    def known(match):
        if match.group(2):
            fields = {}
            for field in match.group(1).split(";"):
                if field.strip():
                    base, sizes, end = typed(field.strip(), 0, types)
                    for size in reversed(sizes):
                        base = Type(times(size, base.width))
                    for name in field.strip()[end:].split(","):
                        fields[name.strip()] = base
            types[match.group(2)] = Type(total(field.width for field in fields.values()), False, fields)
            return ""
        base, sizes, _ = typed(match.group(3), 0, types)
        if sizes:
            raise ValueError(f"'{match.group(0)}': a type of several dimensions")
        types[match.group(4)] = base
        return ""

    return struct.sub(known, text)


def declared(base, sizes):
    width = Variable(base, sizes, 0).width_behind(0)
    sign = " signed" if base.signed and not sizes else ""
    return f"logic{sign}" + ("" if width == "1" else f" [{width}-1:0]")


def declarations(text, types):
    """Makes declarations flat; the text, and the variables by name."""
    found = {}
    start = re.compile(r"(?<![.\w'$])(logic|" + "|".join(types) + r")\b(?!')")
    at = 0
    while match := start.search(text, at):
        base, sizes, end = typed(text, match.start(), types)
        name = re.compile(r"\s*(\w+)").match(text, end)
        if not name:
            at = match.end()
            continue
        new = declared(base, sizes)
        behind = name.end()
        while True:
            unpacked, behind = brackets(text, behind)
            if sizes or base.fields:
                found[name.group(1)] = Variable(base, sizes, len(unpacked))
            name = re.compile(r"\s*,\s*(\w+)\s*(?=[,;\[)=])").match(text, behind)
            if not name or name.group(1) in KEYWORDS or name.group(1) in types:
                break
            behind = name.end()
        text = text[:match.start()] + new + text[end:]
        at = match.start() + len(new)
    return text, found


def cast(base, value):
    if base.fields:
        return f"({value})"
    return f"$signed({base.width}'({value}))" if base.signed else f"{base.width}'({value})"


def casts(text, types):
    types = {**types, "int": Type("32", True)}
    pattern = re.compile(r"\b(" + "|".join(types) + r")'\(")
    while match := pattern.search(text):
        end = end_of(text, match.end() - 1)
        text = text[:match.start()] + cast(types[match.group(1)], text[match.end():end - 1]) + text[end:]
    return re.sub(r"\$bits\((\w+)\)", lambda match: types[match.group(1)].width if match.group(1) in types else match.group(0), text)


def concatenation(base, text):
    values = dict(part.strip().split(":", 1) for part in split(text, ","))
    if set(values) != set(base.fields):
        raise ValueError(f"'{text.strip()[:40]}': not all fields, or others")
    return "{" + ", ".join(f"{field.width}'({values[name].strip()})" for name, field in base.fields.items()) + "}"


def patterns(text, types, variables):
    pattern = re.compile(r"(?:\b(?P<type>\w+)|\b(?P<name>\w+)(?P<index>\s*\[[^;]*\])?\s*(?P<equals><?=)\s*)'\{")
    at = 0
    while match := pattern.search(text, at):
        base = types[match["type"]] if match["type"] else variables[match["name"]].base
        end = end_of(text, match.end() - 1)
        new = concatenation(base, text[match.end():end - 1])
        begin = match.end() - 2 if match["equals"] else match.start()
        text = text[:begin] + new + text[end:]
        at = begin
    return text


def selected(name, variable, text, at):
    """What stands for the selects and fields that follow at `at`, and the place behind them."""
    kept = ""
    for _ in range(variable.unpacked):
        if not RANGE.match(text, at):
            return name, at
        begin = RANGE.match(text, at).end() - 1
        at = end_of(text, begin)
        kept += text[begin:at]
    depth, base, offset = 0, variable.base, []
    width, one, signed = variable.width_behind(0), False, False
    while True:
        select = RANGE.match(text, at)
        field = re.compile(r"\.(\w+)").match(text, at)
        if select:
            end = end_of(text, select.end() - 1)
            index = text[select.end():end - 1].strip()
            unit = variable.width_behind(depth + 1) if depth < len(variable.sizes) else "1"
            at, depth, signed = end, depth + 1, False
            parts = re.fullmatch(r"(.*?)\s*([+-]:|:)\s*(.*)", index, re.DOTALL) if len(split(index, ":")) > 1 else None
            if parts:
                first, how, last = parts.groups()
                low = {"+:": f"({first})", "-:": f"(({first})-({last})+1)", ":": f"({last})"}[how]
                size = f"(({first})-({last})+1)" if how == ":" else f"({last})"
                offset.append(times(low, unit))
                width = times(size, unit)
                break
            offset.append(times(index if number(index) is not None else f"({index})", unit))
            width, one = unit, depth > len(variable.sizes)
            if one:
                break
            signed = depth == len(variable.sizes) and base.signed
        elif field and depth >= len(variable.sizes) and field.group(1) in base.fields:
            offset.append(base.offset_of(field.group(1)))
            base = base.fields[field.group(1)]
            variable = Variable(base, [], 0)
            depth, at, width, signed = 0, field.end(), base.width, base.signed
        else:
            break
    if not offset:
        return name + kept, at
    place = total(offset)
    return (f"{name}{kept}[{place}]" if one or width == "1" else f"{name}{kept}[{place}+:{width}]", at) if not signed else (
        f"$signed({name}{kept}[{place}+:{width}])", at)


def uses(text, variables):
    if not variables:
        return text
    pattern = re.compile(r"(?<![.\w'])(" + "|".join(variables) + r")\b(?=\s*[\[.])")
    at = 0
    while match := pattern.search(text, at):
        name = match.group(1)
        new, end = selected(name, variables[name], text, match.end())
        begins = re.search(r"(;|\bbegin(\s*:\s*\w+)?|\bend|\belse|\)|:)\s*$", text[:match.start()])
        if new.startswith("$signed(") and begins and re.match(r"\s*(<=|=(?!=))", text[end:]):
            new = new[len("$signed("):-1]
        text = text[:match.start()] + new + text[end:]
        at = match.start() + len(name)
        if new.startswith("$signed("):
            at += len("$signed(")
    return text


def plain(text, known, constants):
    """A file's text; what packages have is added to the types that are known, and to the constants."""
    text = without_packages(text)
    types = dict(known)
    if re.search(r"^\s*module\b", text, re.MULTILINE) is None:
        text = with_values(text, constants)
        types = known
    text = typedefs(text, types)
    if not types:
        return casts(text, types)
    constant = re.compile(r"(?<![\w'])(" + "|".join(types) + r")\b(?=\s+\w+\s*\()")
    text = constant.sub(lambda match: declared(types[match.group(1)], []), text)  # what functions return
    text, variables = declarations(text, types)
    text = patterns(text, types, variables)
    return uses(casts(text, types), variables)


def main(paths):
    types, constants = {}, {}
    for path in paths:
        with open(path, encoding="utf-8") as file:
            print(plain(file.read(), types, constants))


if __name__ == "__main__":
    main(sys.argv[1:])
