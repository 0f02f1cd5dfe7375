"""Follows one parameter through the calls that pass it on, by reading the code alone. A stay is a change of file along the calls, in
the order in which they are written; a return is a stay in a file that was entered before.

What is followed is called *I*: the parameter, and what is reached from it by fields and methods (`draft.document`,
`document.frame()?`), also under the names that `let`, `for` and closures give it. I go into a function or method that takes me as an
argument; one that I am only asked by, as the receiver, tells something of me and is no stay. What a function makes of me is not me.
Each function is walked once; where it is called again its file is a stay, and the walk goes on behind the call.

A name is resolved as the code's imports, `impl` blocks and declared types say; where several definitions remain, which only a
compiler or the running program could tell apart, the call is passed over. A function that a module only hands on (`content::read` of
`content/file.rs`) is behind that module's door: a walk goes there only where it is told to."""
import re
from collections import defaultdict

from rust_source import CLOSED_BY, closing

# What holds one thing is taken for that thing.
WRAPPERS = {"Option", "Result", "Arc", "Rc", "Box", "Vec", "Cow", "RefCell", "Mutex", "RwLock", "Ref", "RefMut", "Cell"}
KEYWORDS = {"if", "else", "match", "while", "for", "in", "loop", "return", "let", "mut", "ref", "move", "fn", "as", "where", "break"}
OPENED = set(CLOSED_BY.values())


class Function:
    """A function: where it is, its parameters with their types, and the words of its body."""

    def __init__(self, source, owner, name, parameters, made, body):
        self.source, self.owner, self.name = source, owner, name
        self.parameters, self.made, self.body = parameters, made, body

    def is_method(self):
        """Whether its first parameter is `self`."""
        return bool(self.parameters) and self.parameters[0][0] == ["self"]

    def __repr__(self):
        return f"{self.owner}::{self.name}" if self.owner else self.name


def is_name(word):
    """Whether a word may be a variable's, a function's or a module's name."""
    return re.fullmatch(r"[a-z_]\w*", word) is not None and word not in KEYWORDS


def type_of(words, owner=None):
    """The type that words name, without what wraps it."""
    for i, word in enumerate(words):
        if word[0].isupper() and word not in WRAPPERS and words[i + 1 : i + 2] != ["::"]:
            return owner if word == "Self" else word
    return None


def pieces(words, of_types=False):
    """Words cut at the commas outside brackets; among types angle brackets are brackets too."""
    opening, ending = (set(CLOSED_BY) | {"<"}, OPENED | {">"}) if of_types else (CLOSED_BY, OPENED)
    cut, depth = [[]], 0
    for word in words:
        depth += (word in opening) - (word in ending)
        if word == "," and depth == 0:
            cut.append([])
        else:
            cut[-1].append(word)
    return [piece for piece in cut if piece]


class Index:
    """All functions of a workspace by name, the types of all fields, and each file's imports."""

    def __init__(self, workspace):
        self.crates = set(workspace.crates)
        self.functions, self.fields, self.imports = defaultdict(list), {}, defaultdict(dict)
        for source in workspace.files:
            self._read(source)

    def _read(self, source):
        words, owners = source.words, []
        for at, word in enumerate(words):
            while owners and at > owners[-1][1]:
                owners.pop()
            begins = at == 0 or words[at - 1] in (";", "}", "{", "]", ")", "pub", "unsafe", "const", "async", '""')
            if word in ("impl", "trait") and begins:
                start = next(i for i in range(at, len(words)) if words[i] in ("{", ";"))
                owners.append((self._owner(words[at + 1 : start]), closing(words, start)))
            elif word == "fn" and is_name(words[at + 1]):
                self._read_function(source, words, at, owners[-1][0] if owners else None)
            elif word == "struct" and begins:
                self._read_fields(words, at)
            elif word == "use" and begins:
                end = words.index(";", at)
                self._read_import(source, [], words[at + 1 : end])

    @staticmethod
    def _owner(words):
        if words[:1] == ["<"]:
            depth, at = 0, 0
            for at, word in enumerate(words):
                depth += (word == "<") - (word == ">")
                if depth == 0:
                    break
            words = words[at + 1 :]
        if "where" in words:
            words = words[: words.index("where")]
        return type_of(words[words.index("for") + 1 :] if "for" in words else words)

    def _read_function(self, source, words, at, owner):
        opens = next(i for i in range(at, len(words)) if words[i] == "(")
        closes = closing(words, opens)
        start = next((i for i in range(closes, len(words)) if words[i] in ("{", ";")), closes)
        parameters = []
        for piece in pieces(words[opens + 1 : closes], of_types=True):
            colon = piece.index(":") if ":" in piece else len(piece)
            names = [word for word in piece[:colon] if is_name(word)]
            parameters.append((names, owner if names == ["self"] else type_of(piece[colon + 1 :], owner)))
        made = type_of([word for word in words[closes:start] if word != "where"], owner)
        body = words[start + 1 : closing(words, start)] if words[start] == "{" else []
        if body:
            name = words[at + 1]
            self.functions[name].append(Function(source, owner, name, parameters, made, body))

    def _read_fields(self, words, at):
        start = next((i for i in range(at, len(words)) if words[i] in ("{", ";", "(")), at)
        if words[start] != "{":
            return
        for piece in pieces(words[start + 1 : closing(words, start)], of_types=True):
            if ":" in piece and piece.index(":") > 0:
                colon = piece.index(":")
                self.fields[words[at + 1], piece[colon - 1]] = type_of(piece[colon + 1 :], words[at + 1])

    def _read_import(self, source, before, words):
        if "{" in words:
            start = words.index("{")
            for piece in pieces(words[start + 1 : closing(words, start)]):
                self._read_import(source, before + words[:start], piece)
            return
        path = [word for word in before + words if word != "::"]
        name = path[-1]
        if "as" in path:
            path, name = path[:-2], path[-1]
        if path[-1] == "self":
            path = path[:-1]
            name = path[-1] if name == "self" else name
        self.imports[source.path][name] = path

    def at(self, path, parameter):
        """The one function of a path such as `page::draw` or `PickNode::execute` that has this parameter."""
        before, name = path.split("::")
        found = [
            one
            for one in self.functions.get(name, [])
            if before in (one.owner, *one.source.module()[-1:]) and any(parameter in names for names, _ in one.parameters)
        ]
        if len(found) != 1:
            raise SystemExit(f"{path}:{parameter} begins a journey; {len(found)} functions are called so")
        return found[0]

    def named(self, caller, path, behind_doors):
        """The function that a path names in a file; `None` where there is none, or one of several."""
        *before, name = path
        imports = self.imports[caller.source.path]
        is_qualified = bool(before)
        if before and before[0] == "Self" and caller.owner:
            before = [caller.owner]
        elif before and before[0] in imports:
            before = imports[before[0]] + before[1:]
        elif not before and name in imports:
            *before, name = imports[name]
        found = self.functions.get(name, [])
        if before and before[-1][0].isupper():
            return self._nearest(caller, [one for one in found if one.owner == before[-1]], before)
        found = [one for one in found if one.owner is None]
        if not before:
            beside = [one for one in found if one.source is caller.source]
            beside = beside or [one for one in found if "*" in imports and one.source.crate == caller.source.crate]
            return beside[0] if len(beside) == 1 else None
        modules = [part for part in before if part not in ("crate", "self", "super") and part not in self.crates]
        inside = [one for one in found if one.source.module()[-len(modules) :] == modules] if modules else found
        if not inside and (not is_qualified or behind_doors):
            inside = [one for one in found if modules[-1] in one.source.module()]
        return self._nearest(caller, inside, before)

    def method(self, caller, kind, name):
        """The method of a type, or the only one of that name where the type is not known."""
        found = [one for one in self.functions.get(name, []) if one.is_method() and (not kind or one.owner == kind)]
        if not kind and (name in OF_THE_LIBRARY or len(found) != 1):
            return None
        return self._nearest(caller, found, [])

    def _nearest(self, caller, found, path):
        """The one of several that lies in the crate that a path names, or else in the caller's, or in one that its file imports."""
        crate = path[0] if path and path[0] in self.crates else caller.source.crate
        imported = {path[0] for path in self.imports[caller.source.path].values()}
        for near in ({crate}, {caller.source.crate}, imported):
            within = [one for one in found if one.source.crate in near]
            if within:
                return within[0] if len(within) == 1 else None
        return found[0] if len(found) == 1 else None


# Names that a method of the standard library or of arrays has too: on what has no known type they are taken for that.
OF_THE_LIBRARY = set(
    """abs all and_then any as_ref as_mut as_str as_slice borrow chain chunks clear clone cloned collect contains copied count dot
    entry enumerate eq expect extend fill filter find first flatten fmt fold from get get_mut get_or_insert height hash insert into into_iter is_empty iter
    iter_mut join keys last len length lines load lock lower map map_err max min next normalize ok open parent parse path pop position push
    read remove replace retain rev round send size skip sort split store sum swap take text then then_some to_owned to_string
    truncate unwrap_or update values width windows with write zip""".split()
)


class Walk:
    """One journey: the functions that I enter, in their order, all of given crates."""

    def __init__(self, index, start, crates, behind_doors):
        path, parameter = start.rsplit(":", 1)
        self.index, self.crates, self.behind_doors = index, crates, behind_doors
        self.visited, self.entered = set(), []
        self.enter(index.at(path, parameter), {parameter})

    def stays(self):
        """The functions that I come in by at each change of file."""
        before = [None, *(function.source for function in self.entered)]
        return [function for function, left in zip(self.entered, before) if function.source is not left]

    def returns(self):
        """The number of stays in files that I had left."""
        stays = self.stays()
        return len(stays) - len({function.source.path for function in stays})

    def enter(self, function, names):
        """Goes into a function, where I have these names."""
        if function.source.crate not in self.crates:
            return
        self.entered.append(function)
        if function not in self.visited:
            self.visited.add(function)
            Body(self, function, names).walk()


class Body:
    """The body of a function while it is walked: my names in it, and the types of its variables."""

    def __init__(self, walk, function, names):
        self.onward, self.index, self.function, self.words = walk, walk.index, function, function.body
        self.mine = set(names)
        self.types = {name: kind for names, kind in function.parameters for name in names if len(names) == 1}

    def walk(self):
        """Walks the words in their order."""
        words = self.words
        for at, word in enumerate(words):
            if word == "let":
                self._bind(at)
            elif word == "for" and "in" in words[at : at + 12]:
                behind = at + words[at : at + 12].index("in")
                self._name(words[at + 1 : behind], self._reaches_me(behind + 1), None)
            elif word == "|" and words[at - 1] in ("(", ",", "move"):
                self._bind_closure(at)
            elif word == "(" and at > 0:
                self._call(at)

    def _bind(self, at):
        words = self.words
        equal = next((i for i in range(at, len(words)) if words[i] in ("=", ";")), len(words) - 1)
        pattern = words[at + 1 : equal]
        stated = None
        if ":" in pattern and "{" not in pattern:
            stated = type_of(pattern[pattern.index(":") :], self.function.owner)
            pattern = pattern[: pattern.index(":")]
        kind, end = self._chain(equal + 1)
        self._name(pattern, self._reaches_me(equal + 1), stated or kind)

    def _bind_closure(self, at):
        """`me.iter().map(|one| …)`: one of me is me."""
        words = self.words
        end = next((i for i in range(at + 1, len(words)) if words[i] == "|"), at)
        opens, depth = at - 1, 0
        while opens > 0 and not (words[opens] == "(" and depth == 0):
            depth += (words[opens] in OPENED) - (words[opens] in CLOSED_BY)
            opens -= 1
        start = self._start_of_chain(opens)
        is_mine = opens > 1 and words[opens - 2] == "." and words[start] in self.mine
        self._name([word for piece in pieces(words[at + 1 : end]) for word in piece if ":" not in piece], is_mine, None)

    def _name(self, pattern, is_mine, kind):
        names = [word for i, word in enumerate(pattern) if is_name(word) and pattern[i + 1 : i + 2] not in (["::"], [":"], ["("])]
        for name in names:
            (self.mine.add if is_mine else self.mine.discard)(name)
            self.types[name] = kind if len(names) == 1 else None

    def _reaches_me(self, at):
        """Whether the expression at `at` is me, or reached from me."""
        words = self.words
        while at < len(words) and words[at] in ("&", "*", "mut", "&&", "("):
            at += 1
        if at >= len(words) or words[at] not in self.mine:
            return False
        _, end = self._chain(at)
        return end >= len(words) or words[end] in (";", "{", "else", ")", ",", "..")

    def _start_of_chain(self, opens):
        """The index at which the chain begins whose call has its bracket at `opens`."""
        words, at = self.words, opens - 1
        while at > 0:
            if words[at] in OPENED and words[at] != "}":
                depth = 0
                while at >= 0:
                    depth += (words[at] in OPENED) - (words[at] in CLOSED_BY)
                    if depth == 0:
                        break
                    at -= 1
                if at > 0 and (is_name(words[at - 1]) or words[at - 1][0].isupper() or words[at - 1] in ")]?"):
                    at -= 1
                    continue
                return at
            if words[at] == "?" or words[at - 1] in (".", "::"):
                at -= 1 if words[at] == "?" else 2
                continue
            return at
        return max(at, 0)

    def _chain(self, at, until=None):
        """The type of a chain of fields and calls that begins at `at`, and the index behind it; ends at `until`."""
        words, kind = self.words, None
        while at < len(words) and words[at] in ("&", "*", "mut", "&&"):
            at += 1
        path = []
        while at < len(words) and (is_name(words[at]) or words[at][0].isalpha()) and words[at] not in KEYWORDS:
            path.append(words[at])
            at += 1
            if words[at : at + 1] != ["::"] or at == until:
                break
            at += 1
        if words[at : at + 1] == ["("] and at != until:
            found = self.index.named(self.function, path, self.onward.behind_doors) if path else None
            kind, at = found.made if found else None, closing(words, at) + 1
        elif len(path) == 1:
            kind = self.function.owner if path[0] == "self" else self.types.get(path[0])
        elif path and words[at : at + 1] != ["{"]:
            kind = None
        if words[at : at + 1] == ["{"] and path and path[-1][0].isupper():
            kind = self.function.owner if path[-1] == "Self" else path[-1]
            return kind, at
        while at < len(words) and at != until:
            if words[at] == "?":
                at += 1
            elif words[at] == "[":
                at = closing(words, at) + 1
            elif words[at] == "." and at + 1 < len(words):
                name, behind = words[at + 1], at + 2
                if behind == until:
                    return kind, behind
                if words[behind : behind + 1] == ["("]:
                    found = self.index.method(self.function, kind, name)
                    if found:
                        kind = found.made
                    elif name not in KEEPING:
                        kind = None
                    at = closing(words, behind) + 1
                else:
                    kind = self.index.fields.get((kind, name))
                    at = behind
            else:
                break
        return kind, at

    def _call(self, opens):
        words = self.words
        name = words[opens - 1]
        if not is_name(name) or opens > 1 and words[opens - 2] == "fn":
            return
        ends = closing(words, opens)
        passed = [self._mentions_me(piece) for piece in pieces(words[opens + 1 : ends])]
        if not any(passed):
            return
        is_method = words[opens - 2 : opens - 1] == ["."]
        if is_method:
            start = self._start_of_chain(opens)
            is_receiver = words[start] in self.mine
            kind, _ = self._chain(start, until=opens)
            function = self.index.method(self.function, kind, name)
            passed = [is_receiver, *passed]
        else:
            path = [name]
            at = opens - 2
            while at > 0 and words[at] == "::":
                path.insert(0, words[at - 1])
                at -= 2
            function = self.index.named(self.function, path, self.onward.behind_doors)
        if function is None:
            return
        mine = {one for (names, _), is_mine in zip(function.parameters, passed) if is_mine for one in names}
        if mine:
            self.onward.enter(function, mine)

    def _mentions_me(self, words):
        """Whether an argument is me or holds me; not what a closure does, nor what a function makes of me."""
        at = 0
        while at < len(words):
            if words[at] == "|" or words[at] == "||":
                return False
            if words[at] in self.mine and words[at - 1 : at] != ["."]:
                return True
            if words[at] == "(" and at > 0 and is_name(words[at - 1]):
                at = closing(words, at)
            at += 1
        return False


# Methods that leave a type what it is.
KEEPING = {"clone", "as_ref", "as_mut", "as_deref", "as_deref_mut", "borrow", "borrow_mut", "unwrap_or_default", "ok_or", "ok_or_else",
           "map_err", "to_owned", "iter", "iter_mut", "into_iter", "first", "last", "cloned", "copied", "with_context", "context"}
