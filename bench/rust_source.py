"""Reads the Rust of a checkout as far as `house.py` and `journeys.py` need it: which files are product code, and their words without
comments and tests. It knows no types and expands no macros."""
import re
import tomllib
from pathlib import Path

WORD = re.compile(
    r"""(?P<nothing>\s+|//[^\n]*|/\*.*?\*/|'[A-Za-z_]\w*(?!'))
    |(?P<text>\bb?c?r(?P<hashes>\#*)".*?"(?P=hashes)|\b[bc]?"(?:\\.|[^"\\])*"|"(?:\\.|[^"\\])*"|b?'(?:\\.[^']*|[^\\'])')
    |(?P<word>r\#\w+|\w+|::|->|=>|==|!=|<=|>=|&&|\|\||\.\.=?|.)""",
    re.VERBOSE | re.DOTALL,
)
CLOSED_BY = {"(": ")", "[": "]", "{": "}"}


def closing(words, at):
    """The index of the bracket that closes the one at `at`."""
    depth = 0
    for i in range(at, len(words)):
        if words[i] in CLOSED_BY:
            depth += 1
        elif words[i] in ")]}":
            depth -= 1
            if depth == 0:
                return i
    return len(words) - 1


def end_of_item(words, at):
    """The index behind the item that begins at `at`: behind its semicolon or its braces."""
    while at < len(words) and words[at] not in ";{":
        at = closing(words, at) + 1 if words[at] in CLOSED_BY else at + 1
    if words[at : at + 1] == ["{"]:
        at = closing(words, at)
        # A list of `use` ends at the semicolon behind its braces.
        at += words[at + 1 : at + 2] == [";"]
    return at + 1


class Source:
    """A file of Rust: its path below the root, the crate that it belongs to, its words outside tests (a text or a character is the
    word `""`), and what of it is there for tests."""

    def __init__(self, root, path, crate):
        self.path, self.crate = path.relative_to(root), crate
        self.text = path.read_text(encoding="utf-8")
        words, lines, self.code_lines, line = [], [], set(), 1
        for match in WORD.finditer(self.text):
            piece = match.group()
            last = line + piece.count("\n")
            if match["nothing"] is None:
                words.append(piece if match["text"] is None else '""')
                lines.append(line)
                self.code_lines.update(range(line, last + 1))
            line = last
        self.lines = self.text.count("\n")
        self.test_modules = []
        self.words = self._without_tests(words, lines)

    def _without_tests(self, words, lines):
        kept, at = [], 0
        while at < len(words):
            if words[at : at + 2] != ["#", "["]:
                kept.append(words[at])
                at += 1
                continue
            start, behind = at, closing(words, at + 1) + 1
            attribute = "".join(words[at + 2 : behind - 1])
            at = behind
            if attribute != "test" and not attribute.startswith(("cfg(test)", "cfg(all(test,")):
                continue
            while words[at : at + 2] == ["#", "["]:
                at = closing(words, at + 1) + 1
            item = [word for word in words[at : at + 7] if word not in ("pub", "(", "crate", "super", ")")]
            if item[0] == "mod" and item[2] == ";":
                self.test_modules.append(item[1])
            at = end_of_item(words, at)
            left_out = set(range(lines[start], lines[at - 1] + 1))
            self.code_lines -= left_out
            self.lines -= len(left_out)
        return kept

    def module(self):
        """The names of the modules that lead to the file, its own name last, without the crate's."""
        names = list(self.path.with_suffix("").parts)
        names = names[names.index("src") + 1 :]
        return names[:-1] if names[-1] in ("mod", "lib", "main") else names

    def files_of_tests(self):
        """Where modules of this file that are compiled for tests alone may lie."""
        folder = self.path.parent
        own = folder if self.path.stem in ("mod", "lib", "main") else folder / self.path.stem
        beside = dict(re.findall(r'#\[path = "([^"]+)"\]\s*(?:pub(?:\(\w+\))? )?mod (\w+);', self.text))
        elsewhere = {module: folder / file for file, module in beside.items()}
        for module in self.test_modules:
            yield elsewhere.get(module, own / f"{module}.rs")
            yield own / module / "mod.rs"


class Workspace:
    """A checkout: its crates by the names that code imports them by, and the files of the product, which are those of crates that
    another crate is built on, or that are a program or an extension themselves; without tests."""

    def __init__(self, root):
        self.root = Path(root).resolve()
        manifests = [self.root / "Cargo.toml", *sorted(self.root.glob("crates/*/Cargo.toml"))]
        meant = [(manifest.parent, tomllib.loads(manifest.read_text(encoding="utf-8"))) for manifest in manifests]
        self.crates, self.dependencies = {}, {}
        for folder, manifest in meant:
            name = manifest.get("lib", {}).get("name") or manifest["package"]["name"].replace("-", "_")
            self.crates[name] = folder
            self.dependencies[name] = set(manifest.get("dependencies", {}))
        for_tests = {name for _, manifest in meant for name in manifest.get("dev-dependencies", {})}
        product = [name for name in self.crates if name not in for_tests - set().union(*self.dependencies.values())]
        self.files = [source for name in product for source in self._sources(name)]

    def _sources(self, crate):
        paths = sorted((self.crates[crate] / "src").rglob("*.rs"))
        sources = [Source(self.root, path, crate) for path in paths]
        tests = {path for source in sources for path in source.files_of_tests()}
        # What a module for tests holds is for tests too.
        tests |= {path.parent if path.stem == "mod" else path.with_suffix("") for path in tests}
        return [source for source in sources if not tests.intersection((source.path, *source.path.parents))]
