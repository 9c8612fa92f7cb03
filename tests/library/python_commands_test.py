#!/usr/bin/python3
"""The functions of the package that run commands have all options of the command line.

python_commands_test.py: the table of options is etlc._options, which test_spec compares with that
of the command line.
"""

import inspect
import json
import os
import pickle
import re
import stat
import subprocess
import sys
import tempfile
import unittest
import urllib.request
import warnings
from pathlib import Path

import numpy as np

import etlc
from etlc._keywords import keyword_of, words_of
from etlc._options import OPTIONS

#: Commands without a function: they serve a program, or people who sign for firmware.
WITHOUT = {"lsp", "dossier"}
#: A loop in Python takes several traces.
SEVERAL = ("--data", "--episodes", "--split")
#: The functions of each command, with the options that each of them does not take, or sets itself.
FUNCTIONS = {
    "compile": {
        "compile": {"--check"},
        "check": {"--output", "--check", "--emit", "--standalone", "--namespace",
                  "--inline-targets", "--targets-file", "--depfile"},
    },
    "fit": {"fit": {"--suggest", "--json"}, "suggest": {"--output", "--json"}},
    "label": {"label": {"--proposals"}, "propose": {"--proposals", "--frames", "--port"}},
    "embed": {"embed": {"--pipe"}},  # etlc.Encoder has it
    "run": {"run": {"--summary", "--changes", *SEVERAL}},
    "explain": {"explain": {"--format"}},
    "watch": {"watch": {"--trace"}},
}  # fmt: skip
#: Arguments that the command line cannot have.
MORE = {"embed": {"encoder"}}
#: Arguments that are not named like their option.
NAMED = {"suggest": {"suggest": "predicates"}, "incident": {"file": "data"},
         "evaluate": {"spec": "specs"}, "crossvalidate": {"spec": "specs"}}  # fmt: skip

SPEC = """spec reach;
input z : f32[2];
input x : f32;
target goal = [[0, 0]];
predicate near = l2(z, goal) <= calibrated(f1);
truth near = x <= 1;
let far = !near;
monitor arrives = F near;
sliding monitor soon = F[0, 3] near;
"""


def functions():
    """Yields (command, name, function, options that it takes)."""
    for command, options in OPTIONS.items():
        for name, without in FUNCTIONS.get(command, {command: set()}).items():
            if command not in WITHOUT:
                left = [one for one in options if one.name not in without | {"--diagnostics"}]
                yield command, name, getattr(etlc, name), left


def named(name, option):
    keyword = keyword_of(option)
    return NAMED.get(name, {}).get(keyword, keyword)


class Table(unittest.TestCase):
    def test_every_option_has_its_keyword_and_no_keyword_lacks_its_option(self):
        for command, name, function, options in functions():
            expected = {named(name, option) for option in options}
            found = set(inspect.signature(function).parameters)
            self.assertEqual(found, expected | MORE.get(name, set()), name)

    def test_every_option_is_taken_by_a_function(self):
        for command, options in OPTIONS.items():
            taken = {one.name for by, _, _, left in functions() if by == command for one in left}
            for option in options:
                if command not in WITHOUT and option.name != "--diagnostics":
                    own = {"--pipe", "--summary", "--changes", "--check", "--format", "--json",
                           "--proposals", "--trace", *(SEVERAL if command == "run" else ())}
                    self.assertIn(option.name, taken | own, command)

    def test_every_keyword_is_described(self):
        for _, name, function, options in functions():
            text = inspect.getdoc(function)
            for option in options:
                self.assertRegex(text, rf"\b{named(name, option)}\b[\w, \n]*:", name)

    def test_every_keyword_reaches_the_command(self):
        with tempfile.TemporaryDirectory() as folder:
            said = Path(folder) / "words.json"
            stand_in = Path(folder) / "etlc"
            stand_in.write_text(
                f"#!{sys.executable}\nimport json, sys\n"
                f"json.dump(sys.argv[1:], open({str(said)!r}, 'w'))\nsys.exit(3)\n"
            )
            stand_in.chmod(stand_in.stat().st_mode | stat.S_IXUSR)
            real, os.environ["ETLC_COMMAND"] = os.environ["ETLC_COMMAND"], str(stand_in)
            try:
                for command, name, function, options in functions():
                    self.expect_words(said, command, name, function, options)
            finally:
                os.environ["ETLC_COMMAND"] = real

    def expect_words(self, said, command, name, function, options):
        needed = {
            one.name: "word" for one in inspect.signature(function).parameters.values()
            if one.default is inspect.Parameter.empty
        }  # fmt: skip
        for option in options:
            keyword = named(name, option)
            if keyword == "output" and name in ("explain", "incident"):
                continue  # the function itself writes the text
            value, words = self.value_of(option)
            with self.assertRaises(etlc.SpecError):
                running = function(**{**needed, keyword: value})
                list(running)  # of `watch`
            found = json.loads(said.read_text())
            self.assertEqual(found[0], "word" if command == "compile" else command)
            self.assertIn("\0".join(words), "\0".join(found), f"{name}({keyword}={value!r})")
            if option.manner == "positional":
                self.assertEqual(found[0 if command == "compile" else 1], words[0])

    def value_of(self, option):
        """Returns a value of a keyword, and the words that it stands for."""
        if option.name == "-W":
            return True, ["-Werror"]
        if option.manner == "flag":
            return True, [option.name]
        if option.manner == "word":
            return "host", [f"{option.name}=host"]
        if option.manner in ("several", "any") and "=" not in option.value:
            return ["some", Path("more")], [option.name, "some", "more"]
        if "=" in option.value:
            return {"a": "b", "c": 1}, [f"{option.name}=a=b", f"{option.name}=c=1"]
        if option.manner == "positional":
            return "word", ["word"]
        if "," in option.value:
            return (40, "2s", 4), [option.name, "40,2s,4"]
        if "/" in option.value:
            return (1, 3), [option.name, "1/3"]
        if option.value in ("N", "MB"):
            return 7, [option.name, "7"]
        return "seven", [option.name, "seven"]

    def test_a_wrong_name_says_which_is_near(self):
        for mistake, words in (
            (lambda: etlc.run("a", "b", distance=True),
             "etlc.run has no option distance; did you mean distances?"),
            (lambda: etlc.calibrate("a", "b", job=3),
             "etlc.calibrate has no option job; did you mean jobs?"),
            (lambda: etlc.check("a", colour=3), "etlc.check has no option colour, only spec, "),
        ):  # fmt: skip
            with self.assertRaisesRegex(TypeError, re.escape(words)):
                mistake()
        with self.assertRaisesRegex(TypeError, "missing 1 required positional argument: 'trace'"):
            etlc.run("a")

    def test_wrong_values(self):
        for mistake, words in (
            (lambda: etlc.run("a", "b", distances=1), "distances is 1, expected True or False"),
            (lambda: etlc.fit("a", "b", settings="k=1=2"), "settings|k"),
            (lambda: etlc.fit("a", "b", settings=[1]), r"settings is \[1\], expected a dict"),
            (lambda: etlc.fit("a", "b", jobs=True), "jobs is True, expected N"),
            (lambda: etlc.fit("a", "b", jobs=0), "--jobs: found '0', expected"),
            (lambda: etlc.fit("a", "b", jobs=False), "jobs is False, expected N"),
            (lambda: etlc.fit("a", "b", jobs=[1]), r"jobs is \[1\], expected N"),
            (lambda: etlc.fit("a", 3), "data is 3, expected FILE..."),
            (lambda: etlc.fit("a", []), "data is empty, expected FILE..."),
            (lambda: etlc.fit("a", {"z": np.zeros(3)}), "data is {.*, expected FILE..."),
            (lambda: etlc.fit("a", ["b", None]), "data is None: expected str, bytes or os.PathL"),
            (lambda: etlc.fit("a", ""), "data is '', expected a path"),
            (lambda: etlc.fit("a", "b", labels=[]), "labels is empty, expected FILE..."),
            (lambda: etlc.fit("a", "b", groups=["g"]), r"groups is \['g'\], expected PATTERN"),
            (lambda: etlc.fit("a", "b", output=3), "output is 3: expected str, bytes or os.Path"),
            (lambda: etlc.fit(3, "b"), "spec is 3: expected str, bytes or os.PathLike"),
            (lambda: etlc.run("a", {"x": [1]}), "trace is {.*, expected FILE"),
            (lambda: etlc.explain("a", "b", monitor=["m"]), r"monitor is \['m'\], expected NAME"),
            (lambda: etlc.explain("a", "b", step=np.arange(2)), r"step is array.*, expected N"),
            (lambda: etlc.suggest("a", "b", 3), "suggest is 3"),
            (lambda: etlc.check("a", values="bool"), "--values: found 'bool', expected robustn"),
        ):  # fmt: skip
            with self.assertRaisesRegex(etlc.InputError, words) as raised:
                mistake()
            self.assertNotIn("--help", str(raised.exception))

    def test_a_file_with_the_name_of_an_option(self):
        with self.assertRaisesRegex(etlc.SpecError, r"^./--jobs: error: no such file \[E0902\]"):
            etlc.fit("--jobs", ["--labels", "-b"], output="t.npz")
        given = {"spec": "-a", "data": ["--labels", "-b", "c"], "jobs": np.int64(2)}
        words = [b"fit", b"./-a", b"--data", b"./--labels", b"./-b", b"c", b"--jobs", b"2"]
        self.assertEqual(words_of("fit", given)[:8], words)


class Commands(unittest.TestCase):
    def setUp(self):
        box = tempfile.TemporaryDirectory()
        self.addCleanup(box.cleanup)
        self.path = Path(box.name)
        self.spec = self.path / "reach.etl"
        self.spec.write_text(SPEC)
        random = np.random.default_rng(3)
        for folder in ("data", "others"):
            (self.path / folder).mkdir()
            for n in range(10):
                x = np.abs(random.normal(size=30) * 2).astype("f4")
                z = np.stack([x, random.normal(size=30) / 3], 1).astype("f4")
                np.savez(self.path / folder / f"{n}.npz", x=x, z=z)
        warnings.simplefilter("ignore", etlc.EtlcWarning)
        self.addCleanup(warnings.resetwarnings)

    def calibrated(self):
        return etlc.calibrate(self.spec, self.path / "data").path

    def test_check(self):
        checked = etlc.check(self.spec)  # without thresholds
        self.assertEqual([one.code for one in checked.diagnostics], ["E0650", "W0201"])
        self.assertEqual(checked.diagnostics[0].severity, "note")
        self.spec.write_text(SPEC.replace("let far", "let near"))
        with self.assertRaises(etlc.SpecError) as raised:
            etlc.check(self.spec)
        errors = [one for one in raised.exception.diagnostics if one.severity == "error"]
        self.assertEqual([one.line for one in errors], [7])
        self.spec.write_text(SPEC + "monitor stays = F G near;")
        with warnings.catch_warnings(record=True) as found:
            warnings.simplefilter("always")
            codes = [one.code for one in etlc.check(self.spec).diagnostics]
            self.assertEqual(codes, ["E0650", "W0201", "W0501"])
        self.assertEqual((found[0].category, found[0].filename), (etlc.EtlcWarning, __file__))
        with self.assertRaisesRegex(etlc.SpecError, "W0501"):
            etlc.check(self.spec, warnings_are_errors=True)

    def test_compile(self):
        self.calibrated()
        made = etlc.compile(self.spec, self.path / "reach.hpp", standalone=True, namespace="one")
        self.assertIn("namespace one", made.path.read_text())
        made = etlc.compile(self.spec, self.path / "plan.txt", emit="plan", recorder=(3, 2, 1))
        self.assertIn("arrives", made.path.read_text())

    def test_run_has_the_bits_of_a_monitor(self):
        self.calibrated()
        trace = self.path / "others" / "3.npz"
        arrays = dict(np.load(trace))
        arrays["z"][3] = np.nan
        np.savez(trace, **arrays)
        found = etlc.run(self.spec, trace, distances=True, lets=True)
        with etlc.Monitor(self.spec, lets=True) as monitor:
            expected = monitor.run(z=arrays["z"], distances=True)
            far = []
            monitor.reset()
            for z in arrays["z"]:
                monitor.step(z=z)
                far.append(monitor.let("far"))
        self.assertEqual(found.episode.monitors, ("arrives", "soon"))
        for field in expected.table.dtype.names:
            np.testing.assert_array_equal(found.episode.table[field], expected.table[field])
        np.testing.assert_array_equal(found.episode.distances["near"], expected.distances["near"])
        np.testing.assert_array_equal(found.lets["far"], np.array(far, "f4"))
        np.testing.assert_array_equal(found.positions[:, 0], 0)
        np.testing.assert_array_equal(found.positions[:, 1], [-1] * 3 + list(range(27)))
        self.assertIn("30 steps", found.summary)
        more = etlc.run(self.spec, trace, finish=True, output=self.path / "rows.csv")
        self.assertEqual(len(more.episode), 33)
        self.assertEqual(more.positions[-1, 1], 29)
        self.assertEqual(len((self.path / "rows.csv").read_text().splitlines()), 1 + 2 * 33)

    def test_run_on_no_steps(self):
        self.calibrated()
        (self.path / "none.csv").write_text("x,z[0],z[1]\n")
        try:
            found = etlc.run(self.spec, self.path / "none.csv", distances=True)
        except etlc.SpecError as error:
            self.assertTrue(error.diagnostics)
        else:
            self.assertEqual(len(found.episode), 0)

    def test_pages_and_pictures(self):
        self.calibrated()
        trace = self.path / "others" / "3.npz"
        etlc.run(self.spec, trace, svg=self.path / "p.svg", html=self.path / "p.html")
        self.assertIn("<svg", (self.path / "p.svg").read_text())
        page = etlc.report(self.spec, self.path / "others", self.path / "r.html", size=5)
        self.assertIn("<html", page.path.read_text()[:300])

    def test_explain(self):
        self.calibrated()
        trace = self.path / "others" / "3.npz"
        why = etlc.explain(self.spec, trace, monitor="soon", step=9, output=self.path / "why.txt")
        self.assertEqual(why.data["monitor"], "soon")
        self.assertTrue(why.text.startswith("soon = F[0, 3] near"))
        self.assertEqual((self.path / "why.txt").read_text(), why.text)
        self.assertIn("<pre>soon", why._repr_html_())
        with self.assertRaisesRegex(etlc.SpecError, "no monitor|not a monitor|sooner"):
            etlc.explain(self.spec, trace, monitor="sooner")

    def test_two_thresholds(self):
        both = "calibrated(conformal, alpha = 0.2, against = both)"
        self.spec.write_text(SPEC.replace("calibrated(f1)", both))
        self.calibrated()
        monitor = etlc.Monitor(self.spec)
        status = []
        found = monitor.measure("near")
        self.assertLess(found.inner_threshold, found.threshold)
        for distance in (0, (found.inner_threshold + found.threshold) / 2, 9):
            monitor.reset()
            verdicts = monitor.step(z=[distance, 0])
            status.append((verdicts.arrives.satisfied, verdicts.arrives.violated))
        self.assertEqual(status, [(True, False), (False, False), (False, True)])
        self.assertIn("inner_threshold", repr(found))

    def test_drift(self):
        normal = "calibrated(normal, alpha = 0.2)"
        self.spec.write_text(
            "spec t;\ninput z : f32[2];\ntarget goal = [[0, 0]];\n"
            f"predicate usual = l2(z, goal) <= {normal};\nmonitor ok = G usual;\n"
            "drift moved = of usual, level = 0.02;\n")
        source, known, later = np.random.default_rng(3), self.path / "known", self.path / "later"
        for folder, count in ((known, 30), (later, 60)):
            folder.mkdir()
            for i in range(count):
                shift = 1 if folder is later and i >= 20 else 0
                np.savez(folder / f"{i:02}.npz", z=source.normal(shift, 1, (8, 2)).astype("f4"))
        etlc.calibrate(self.spec, known)
        lines = subprocess.run(
            [os.environ["ETLC_COMMAND"], "run", self.spec, "--data", later, "--summary", "-o",
             self.path / "rows.csv"],
            check=True, capture_output=True, text=True).stdout.splitlines()  # fmt: skip
        expected = [line for line in lines if line.startswith("drift")]
        monitor = etlc.Monitor(self.spec)
        self.assertEqual(monitor.drift("moved").wealth, 1)
        found = []
        for i, path in enumerate(sorted(later.iterdir())):
            episode = np.load(path)["z"]
            if i % 2:
                monitor.step(z=episode[0] + 9)
                monitor.reset()  # an episode that was cut short does not count
            for z in episode:
                monitor.step(z=z)
            monitor.end_episode()
            monitor.reset()
            drift = monitor.drift("moved")
            found.append(
                f"drift moved: {'ALARM' if drift.alarm else 'no alarm'} after {drift.episodes} "
                f"episode{'' if drift.episodes == 1 else 's'}, "
                f"wealth {drift.wealth:.3g} of {drift.limit:.3g}")
            self.assertEqual(len(drift.counts), 8)
            if i == 10:
                monitor = pickle.loads(pickle.dumps(monitor))
        self.assertEqual(found, expected)
        self.assertIn("no alarm", found[19])
        self.assertIn("ALARM", found[-1])
        with self.assertRaisesRegex(etlc.InputError, "the spec has no drift 'nothing'"):
            monitor.drift("nothing")

    def test_crossvalidate(self):
        found = etlc.crossvalidate(self.spec, self.path / "data", folds=3)
        self.assertEqual(len(found.data["folds"]), 3)
        self.assertIn("near", found.data["predicates"])

    def test_variants_and_files_of_evaluate(self):
        self.calibrated()
        found = etlc.evaluate(self.spec, self.path / "others", variants=["cut", "reversed"],
                              json=self.path / "e.json", csv=self.path / "e.csv")  # fmt: skip
        self.assertEqual(json.loads((self.path / "e.json").read_text()), found.data)
        self.assertTrue((self.path / "e.csv").read_text().startswith("kind,name,level,figure,"))

    def test_shards(self):
        whole = self.calibrated().read_text()
        parts = [
            etlc.calibrate(self.spec, self.path / "data", shard=(n, 2), part=self.path / f"{n}.p")
            for n in (1, 2)
        ]
        merged = etlc.merge([one.path for one in parts], self.path / "merged.json")
        self.assertEqual(merged.path.read_text(), whole)

    def test_suggest(self):
        found = etlc.suggest(self.spec, self.path / "data", "near")
        self.assertIn("near", json.dumps(found.data))
        with self.assertRaises(etlc.Error):
            etlc.suggest(self.spec, self.path / "data", ["nearer"])

    def test_label(self):
        with etlc.label(self.spec, self.path / "data") as page:
            self.assertEqual(page.tables, (str(self.path / "data" / "labels.csv"),))
            with urllib.request.urlopen(page.address) as answer:
                self.assertIn(b"<html", answer.read(500))
        with self.assertRaises(OSError):
            urllib.request.urlopen(page.address)
        with self.assertRaisesRegex(etlc.SpecError, "no-such"):
            etlc.label(self.spec, self.path / "no-such")
        with self.assertRaisesRegex(etlc.InputError, "--port"):
            etlc.label(self.spec, self.path / "data", port=0)
        self.assertIsInstance(etlc.propose(self.spec, self.path / "data").data, dict)

    def test_prove_and_watch(self):
        text = "spec t; input x : f32; predicate p = x > 0; monitor m = F[0, 3] p;"
        (self.path / "t.etl").write_text(text)
        proof = etlc.prove(self.path / "t.etl", steps=8, output=self.path / "t.txt")
        self.assertEqual(str(proof), (self.path / "t.txt").read_text())
        self.assertIn("8 steps", proof.certificate)
        with self.assertRaises(etlc.SpecError):
            etlc.prove(self.path / "none.etl")
        with self.assertRaises(etlc.SpecError):  # it has no encoder
            list(etlc.watch(self.path / "t.etl", self.path / "none.mp4"))
        with etlc.watch(self.path / "t.etl", "none.mp4") as watching:
            watching.stop()

    def test_annotate_names_what_is_wrong(self):
        spec = self.path / "home.etl"
        spec.write_text("spec h; input x : f32; monitor home = F x < 1;")
        with self.assertRaisesRegex(etlc.SpecError, "is no LeRobot data set"):
            etlc.annotate(spec, self.path / "none", self.path / "out", success="home")
        with self.assertRaises(etlc.InputError):  # neither an output nor in place
            etlc.annotate(spec, self.path / "none", success="home")

    def test_split(self):
        names = [str(self.path / "split" / f"{n:02}.npz") for n in range(20)]
        (self.path / "split").mkdir()
        for n, name in enumerate(names):
            np.savez(name, z=np.full((3, 2), n))
        in_order = etlc.split(self.path / "split", 0.25, 0.25, 0.5, by="order")
        self.assertEqual(in_order, [names[:5], names[5:10], names[10:]])
        dealt = etlc.split(self.path / "split", 0.25, 0.25, 0.5)
        spec = self.path / "split.etl"
        spec.write_text("spec s;\ninput z : f32[2];\ntarget origin = [[0, 0]];\n"
                        "monitor m = F l2(z, origin) < 1;\n")

        def kept(part, code=0):
            command = [etlc._process.command_path(), "run", spec, "--data", self.path / "split"]
            ran = subprocess.run([*command, "--split", part], capture_output=True, text=True)
            self.assertEqual(ran.returncode, code, ran.stderr)
            return list(dict.fromkeys(line.split(",")[0] for line in ran.stdout.splitlines()[1:]))

        parts = ("0:0.25", "0.25:0.5", "0.5:1")
        self.assertEqual([kept(part + ":order") for part in parts], in_order)
        self.assertEqual([kept(part) for part in parts], [sorted(part) for part in dealt])
        for wrong in ("0.5", "0.5:0.5", "0.5:0.2", "-1:1", "0:2", "0:1:name", "0:x", "nan:1", ""):
            kept(wrong, code=2)
        kept("0:0.01", code=1)  # nobody is in it
        self.assertEqual([len(part) for part in dealt], [5, 5, 10])
        self.assertEqual(sorted(sum(dealt, [])), names)
        self.assertNotEqual(dealt, in_order)
        content = [[np.load(name)["z"][0, 0] for name in part] for part in dealt]
        os.rename(self.path / "split", self.path / "moved")
        for n, name in enumerate(names):  # the names do not matter
            moved = name.replace("split", "moved")
            os.rename(moved, moved.replace(f"{n:02}.npz", f"{(7 * n) % 20}x.npz"))
        again = etlc.split(str(self.path / "moved" / "*.npz"), 0.25, 0.25, 0.5)
        self.assertEqual([[np.load(name)["z"][0, 0] for name in part] for part in again], content)
        for shares, by in (((0.5, 0.6), "hash"), ((1,), "hash"), ((0.5, 0.5), "name"),
                           ((0.01, 0.99), "hash")):
            with self.assertRaises(etlc.InputError):
                etlc.split(self.path / "moved", *shares, by=by)
        with self.assertRaises(etlc.InputError):
            etlc.split(self.path / "none", 0.5, 0.5)


if __name__ == "__main__":
    unittest.main()
