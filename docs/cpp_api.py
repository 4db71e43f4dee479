"""Pages of the C++ headers, made from their declarations and comments: a directive of Sphinx, without another program.

    .. cpp-header:: keyblock/scenario.h

It knows how the public headers are written: `///` above a declaration or `///<` after it, one namespace, classes that are not nested.
A declaration that Sphinx cannot read is a warning, and so an error of the site."""

import dataclasses
import pathlib
import re

INCLUDE = pathlib.Path(__file__).resolve().parents[1] / "include"

TYPE = re.compile(r"(?P<kind>class|struct) (?P<name>\w+)(?P<bases>[^{;]*)\{$")
ENUM = re.compile(r"enum class (?P<name>\w+)(?P<type>[^{;]*)\{$")
NOT_SHOWN = re.compile(r"~|.*\boperator=\(|(\w+)\(\1&&\)")  # what owns memory has these


@dataclasses.dataclass
class Entry:
    """A declaration with what is said of it, and the members of a class."""

    kind: str  # class, function, member, enum-class, enumerator
    declaration: str
    comment: list[str]
    members: list["Entry"] = dataclasses.field(default_factory=list)


def read_header(text):
    """What a header declares in `namespace keyblock`, without what is private."""
    return _Reader(text.split("\n")).read()


class _Reader:
    def __init__(self, lines):
        self._lines = iter(lines)

    def read(self):
        for line in self._lines:
            if line.strip() == "namespace keyblock {":
                return self._scope("}")
        return []

    def _scope(self, end):
        """Up to the line that closes it."""
        entries, comment, private = [], [], False
        for line in self._lines:
            line = line.strip()
            if line.split("  //")[0] == end:
                return entries
            if line.startswith("///"):
                comment.append(line[3:])
                continue
            if line in ("public:", "private:"):
                private = line == "private:"
            elif line.startswith("namespace "):
                self._scope("}")
            elif line.startswith("// NOLINT"):
                continue
            elif line.startswith("template "):
                entries += [] if private else [Entry("function", self._template(line), comment)]
            elif line:
                found = self._declaration(line, comment)
                entries += [] if private else found
            comment = []
        return entries

    def _declaration(self, line, comment):
        if table := re.match(r"inline (constexpr \w+ \w+\[\]) = \{$", line):
            self._skip_body(line)
            return [Entry("member", table[1], comment)]
        line, said = self._whole(line)
        comment = comment + said
        words = re.sub(r"KEYBLOCK_API |\[\[nodiscard\]\] |explicit ", "", line)
        if head := TYPE.match(words):
            members = self._scope("};")
            declaration = head["name"] + head["bases"].rstrip()
            return [Entry(head["kind"], declaration, comment, members)]
        if head := ENUM.match(words):
            return [Entry("enum-class", head["name"] + head["type"].rstrip(), comment, self._enumerators())]
        if re.match(r"(class|struct) \w+;|using ", words):
            return []
        if words.startswith("std::function<"):
            return [Entry("member", words.rstrip(";"), comment)]
        if "(" in words.split("=")[0] or "operator" in words:
            return [] if NOT_SHOWN.match(words) else [Entry("function", _signature(words), comment)]
        return [Entry("member", member, comment) for member in _members(words)]

    def _enumerators(self):
        """One a line, up to the line that closes the enumeration."""
        entries = []
        for line in self._lines:
            name, _, said = line.strip().partition("///<")
            if name.strip() == "};":
                return entries
            entries.append(Entry("enumerator", name.strip().rstrip(","), [said] if said else []))
        return entries

    def _skip_body(self, text):
        """The rest of the body of a function."""
        while text.count("{") != text.count("}"):
            text += next(self._lines)

    def _template(self, line):
        """A function template, with its body behind it: what it is shown as. Conditions on its parameters are left to the comment."""
        text = line
        while not (text.endswith((";", "}")) and text.count("{") == text.count("}")):
            line = next(self._lines).strip()
            text += "" if line.startswith("// NOLINT") else " " + line
        head, declaration = re.match(r"template <(.*?)(?:, std::enable_if_t<.*?> = 0)?> (?=\S+[ (])(.*)", text).groups()
        return f"template <{head}> {_signature(declaration)}"

    def _whole(self, line):
        """A declaration may go over several lines; its comment may follow each of them."""
        said, parts = [], []
        while True:
            code, _, after = line.partition("///<")
            said += [after] if after else []
            parts.append(code.strip())
            joined = " ".join(parts)
            if joined.endswith("{") and "(" in joined and joined.count("(") == joined.count(")"):
                self._skip_body(joined)
                return joined + " }", said
            if joined.endswith((";", "{", "}")) and (joined.count("(") == joined.count(")")):
                return joined, said
            line = next(self._lines)


def _signature(words):
    """Of a function: without its body, and without what a constructor begins with."""
    depth = 0
    for place, letter in enumerate(words):
        depth += (letter in "([{") - (letter in ")]}")
        if depth == 0 and letter == ")":
            after = words[place + 1 :]
            rest = re.match(r"\s*(const)?\s*(noexcept)?", after)[0].rstrip()
            return words[: place + 1] + rest
    raise ValueError(words)


def _members(words):
    """`double length, gap = 0.0;` are two members of one type."""
    parts, depth, part = [], 0, ""
    for letter in words.rstrip(";"):
        depth += (letter in "<({[") - (letter in ">)}]")
        if letter == "," and depth == 0:
            parts.append(part)
            part = ""
        else:
            part += letter
    parts.append(part)
    first = parts[0].partition(" = ")[0]
    kind = first.rpartition(" ")[0]
    return [part.strip() if place == 0 else f"{kind} {part.strip()}" for place, part in enumerate(parts)]


def rst(entries, indent=""):
    """Directives of the cpp domain."""
    lines = []
    for entry in entries:
        lines += ["", f"{indent}.. cpp:{entry.kind}:: {entry.declaration}", ""]
        lines += [f"{indent}   {line}" if line else "" for line in _paragraphs(entry.comment)]
        lines += rst(entry.members, indent + "   ")
    return lines


def _paragraphs(comment):
    lines, code = [], False
    for line in comment:
        line = line.removeprefix(" ").rstrip()
        is_code = line.startswith("    ")
        if is_code and not code:
            lines += ["::", ""] if not lines or not lines[-1] else ["", "::", ""]
        code = is_code or (code and not line)
        lines.append(line if is_code else re.sub(r"`([^`]*)`", r"``\1``", line.replace("*", r"\*")))
    return lines


def setup(app):
    from docutils.parsers.rst import Directive
    from docutils.statemachine import StringList

    class Header(Directive):
        required_arguments = 1

        def run(self):
            from docutils import nodes

            path = INCLUDE / self.arguments[0]
            self.state.document.settings.env.note_dependency(str(path))
            section = nodes.container()
            self.state.nested_parse(StringList(rst(read_header(path.read_text())), str(path)), 0, section)
            return section.children

    app.add_directive("cpp-header", Header)
    return {"parallel_read_safe": True}
