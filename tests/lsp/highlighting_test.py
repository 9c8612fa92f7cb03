"""highlighting_test.py SOURCE: the TextMate grammar highlights the lexer's words, and no others.

A word that is only in grammar/EtlLexer.g4 fails here: it has no phrase, and no colour.
"""
import json
import pathlib
import re
import sys

SOURCE = pathlib.Path(sys.argv[1])
GRAMMAR = json.loads((SOURCE / "editors/vscode/syntaxes/etl.tmLanguage.json").read_text())
MARKS = "keyword", "storage", "support", "constant.language"

# Phrases in which a contextual word is a keyword: `lexer word`, then the phrase.
PHRASES = {
    "in": "input x : f32 in [0, 1];", "hold": "input z : f32[2] hold 3;",
    "missing": "input b : bool missing false;", "scale": "input z : i8[4] scale 0.5;",
    "stale": "input z : f32[2], stale after 5;", "after": "input z : f32[2], stale after 0.5 s;",
    "f32": "input x : f32;", "f16": "input x : f16[2];", "i8": "input x : i8[2] scale 1;",
    "bool": "input x : bool;", "restartable": "restartable monitor m = G p;",
    "repeating": "repeating monitor m = G p;",
    "drift": "drift d = of p, level = 0.01;", "rise": "let a = rise p;",
    "fall": "let a = fall (p);", "held": "let a = held[2 s] p;",
    "projection": "projection P = [[1, 2]];",
    "offset": "projection P = [[1, 2]] offset [1, 2];",
    "fitted": "target t = fitted(mean, of = z, where = p);",
    "frames": "target t = frames(\"a.npz\", \"z\", [1, 2]);",
    "stride": "target t = frames(\"a.npz\", \"z\", [1, 9], stride = 2);",
    "of": "target t = load(\"a.npy\") of P(z);", "where": "target t = fitted(mean, where = p);",
    "encoder": "encoder e = load(\"a.onnx\");", "by": "input z : f32[2] by e;",
    "images": "target t = images(\"*.png\") by e;",
    "image": "encoder e = load(\"a.onnx\"), image [2, 2];",
    "deviation": "encoder e = load(\"a.onnx\"), deviation [1, 1, 1];",
    "resize": "encoder e = load(\"a.onnx\"), resize bicubic [256];",
    "flip": "encoder e = load(\"a.onnx\"), flip both;",
    "channels": "encoder e = load(\"a.onnx\"), channels bgr;",
    "margins": "encoder e = load(\"a.onnx\"), margins down;",
    "output": "encoder e = load(\"a.onnx\"), output \"z\";",
    "pool": "encoder e = load(\"a.onnx\"), pool cls;",
    "preprocessor": "encoder e = load(\"a.onnx\"), preprocessor load(\"p.json\");",
    "durations": "rate 20 Hz, durations up;", "up": "rate 20 Hz, durations up;",
    "down": "rate 20 Hz, durations down;", "nearest": "rate 20 Hz, durations nearest;",
    "Hz": "rate 20 Hz;", "us": "period 5 us;", "ms": "period 5ms;", "s": "let a = F[0, n s] p;",
    "steps": "let a = F[0, 2 steps] p;", "step": "input z : f32[2] hold 1 step;",
    "l2": "predicate p = min l2(z, t) < 1;", "l2sq": "predicate p = min l2sq(z, t) < 1;",
    "l1": "predicate p = l1(z, t) < 1;", "linf": "predicate p = linf(z, t) < 1;",
    "cosine": "predicate p = cosine(z, t) < 1;", "angular": "predicate p = angular(z, t) < 1;",
    "mahalanobis": "predicate p = mahalanobis(M)(z, t) < 1;",
    "min": "predicate p = min l2(z, t) < 1;", "max": "predicate p = max(x, y) < 1;",
    "mean": "predicate p = mean l2(z, t) < 1;", "kth": "predicate p = kth(2) l2(z, t) < 1;",
    "abs": "predicate p = abs(x) < 1;", "sqrt": "predicate p = sqrt(x) < 1;",
    "count": "let p = count(a && b, 2 s) < 1;",
    "fraction": "let p = fraction(a && b, 2 s) < 1;",
}


def lexer_words():
    """Returns reserved words with symbols, and contextual words, as the lexer spells them."""
    text = (SOURCE / "grammar/EtlLexer.g4").read_text()
    words = {True: [], False: []}
    reserved = True
    for line in text.split("IDENTIFIER :")[0].splitlines():
        if line.startswith("// ----"):
            reserved = line.startswith("// ---- reserved")
        rule = re.match(r"[A-Z_0-9]+\s*:(.*);", line)
        if rule:
            words[reserved] += re.findall(r"'([^']*)'", rule[1])
    return words[True], words[False]


def patterns():
    for include in GRAMMAR["patterns"]:
        yield from GRAMMAR["repository"][include["include"][1:]]["patterns"]


def coloured(text):
    """Highlights a text as TextMate does: returns words with the names of their scopes."""
    found, at = [], 0
    while True:
        first = None
        for pattern in patterns():
            match = re.compile(pattern.get("match", pattern.get("begin"))).search(text, at)
            if match and (first is None or match.start() < first[0].start()):
                first = match, pattern
        if first is None:
            return found
        match, pattern = first
        end = match.end()
        if "end" in pattern:
            end = re.compile(pattern["end"]).search(text, end).end()
        if "name" in pattern:
            found.append((text[match.start():end], pattern["name"]))
        for group, capture in pattern.get("captures", {}).items():
            if match[int(group)] is not None:
                found.append((match[int(group)], capture["name"]))
        at = max(end, at + 1)


def is_marked(word, text):
    return any(found == word and name.startswith(MARKS) for found, name in coloured(text))


def every_word_is_highlighted():
    reserved, contextual = lexer_words()
    assert len(reserved) > 40 and len(contextual) > 40, (reserved, contextual)
    for word in reserved:
        assert is_marked(word, f"a {word} b"), f"'{word}' is not highlighted"
    for word in contextual:
        assert word in PHRASES, f"'{word}' of the lexer has no phrase here"
        assert is_marked(word, PHRASES[word]), f"'{word}' is not highlighted: {PHRASES[word]}"
    assert set(PHRASES) <= set(contextual), set(PHRASES) - set(contextual)


def no_other_word_is():
    known, checked = set(sum(lexer_words(), [])), set()
    for pattern in patterns():
        captures = pattern.get("captures", {}).values()
        names = [pattern.get("name", "")] + [capture["name"] for capture in captures]
        if not any(name.startswith(MARKS) for name in names):
            continue
        plain = re.sub(r"\[(?:\\.|[^\]])*\]|\\.", " ", pattern.get("match", ""))
        # Lookaheads, innermost brackets first.
        while (looked := re.sub(r"\(\?(?:=|!|<=|<!)[^()]*\)", " ", plain)) != plain or \
                (looked := re.sub(r"\(\?:([^()]*)\)", r" \1 ", plain)) != plain:
            plain = looked
        for word in re.findall(r"[A-Za-z][A-Za-z_0-9]*", plain):
            assert word in known, f"'{word}' is no word of the lexer: {pattern['match']}"
            checked.add(word)
    assert len(checked) > 80, checked


def names_are_not():
    """Contextual words used as names."""
    _, contextual = lexer_words()
    for word in contextual:
        for text in [f"input {word}, b : ", f"predicate {word} = x < 1;", f"let a = p && {word};",
                     f"let a = ({word} until p);", f"let a = {word} -> p;"]:
            assert not is_marked(word, text), text
    assert ("dock", "entity.name.etl") in coloured("spec dock;")
    assert coloured("// monitor m") == [("// monitor m", "comment.line.double-slash.etl")]
    assert coloured("/* G */ p") == [("/* G */", "comment.block.etl")]
    assert coloured('"G"') == [('"G"', "string.quoted.double.etl")]


def the_folder_is_whole():
    """The files named in package.json exist, with the contents that the editor reads."""
    folder = SOURCE / "editors/vscode"
    package = json.loads((folder / "package.json").read_text())
    language, = package["contributes"]["languages"]
    grammar, = package["contributes"]["grammars"]
    assert grammar["language"] == language["id"] and grammar["scopeName"] == GRAMMAR["scopeName"]
    assert language["extensions"] == [".etl"]
    json.loads((folder / language["configuration"]).read_text())
    assert (folder / grammar["path"]).is_file() and (folder / package["main"]).is_file()


every_word_is_highlighted()
no_other_word_is()
names_are_not()
the_folder_is_whole()
print("the words of the lexer are highlighted")
