#!/usr/bin/env python3
"""stored_images_test.py ETLC: data sets with images in their rows give the same frames as these
images as files; a missing or damaged image is reported with its row."""
import json
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

import numpy as np

from encoders import CHECKSUMS
import lerobot
import parquet_writer as parquet

ETLC = os.path.abspath(sys.argv[1])
LENGTHS = (9, 8, 7)
FIRST = [sum(LENGTHS[:i]) for i in range(len(LENGTHS))]
TOP, WRIST = lerobot.CAMERAS

SPEC = """spec seen;
rate {} Hz;
encoder see = load("see.py");
input z : f32[2] by see;
target none = [[0, 0]];
monitor seen = F l2(z, none) <= 1;
"""
BOTH = "input w : f32[2] by see;\nmonitor w_seen = F l2(w, none) <= 1;\n"


def embed(spec, *words, status=0, environment=()):
    shutil.rmtree("out", ignore_errors=True)
    done = subprocess.run([ETLC, "embed", spec, *words, "-o", "out", "--encoder-cmd",
                           f"{sys.executable} see.py"], capture_output=True, text=True,
                          env={**os.environ, **dict(environment)})
    assert done.returncode == status, (words, done.stdout, done.stderr)
    return done.stderr


def made_of(episode, name="z"):
    return np.load(f"out/{episode}.npz")[name]


def image_files(folder, ending, count, pixels="rgb24"):
    """Writes different images to a folder; returns their bytes."""
    os.mkdir(folder)
    height, width = lerobot.SIDES
    lerobot.call("ffmpeg", "-v", "error", "-f", "lavfi", "-i",
                 f"testsrc2=size={width}x{height},hue=h=15*n", "-frames:v", str(count), "-pix_fmt",
                 pixels, f"{folder}/%03d.{ending}")
    return [path.read_bytes() for path in sorted(pathlib.Path(folder).iterdir())]


def turned(jpeg):
    """The same, to be shown rotated by 90 degrees (orientation 6 of EXIF)."""
    exif = b"Exif\0\0MM\0*" + struct.pack(">IHHHIHHI", 8, 1, 0x0112, 3, 1, 6, 0, 0)
    return jpeg[:2] + b"\xff\xe1" + struct.pack(">H", len(exif) + 2) + exif + jpeg[2:]


def embeddings_of_files(images, ending):
    """Returns the frames that `etlc embed` reads from a folder of these files."""
    shutil.rmtree("files", ignore_errors=True)
    os.mkdir("files")
    for number, image in enumerate(images):
        pathlib.Path(f"files/{number:03}.{ending}").write_bytes(image)
    embed("seen.etl", "--data", "files")
    return made_of("files")


def pixels_are_those_of_ffmpeg(files, folder):
    """Decodes PNG: an oracle that shares no code."""
    raw = lerobot.call("ffmpeg", "-v", "error", "-i", f"{folder}/%03d.png", "-f", "rawvideo",
                       "-pix_fmt", "rgb24", "-")
    frames = np.frombuffer(raw, np.uint8).reshape(len(files), -1)
    crc = np.array([zlib.crc32(frame.tobytes()) for frame in frames], np.uint32)
    assert np.array_equal(np.stack([crc & 0xFFFF, crc >> 16], 1).astype(np.float32), files)


def check_release(release, stored, expected, **how):
    name = f"set{release[1]}"
    lerobot.write(name, release, LENGTHS, stored, **how)
    embed("both.etl", "--data", name, "--camera", f"z={TOP}", f"w={WRIST}")
    for episode, (first, length) in enumerate(zip(FIRST, LENGTHS)):
        for array, camera in (("z", TOP), ("w", WRIST)):
            made = made_of(f"{name}-{episode:06}", array)
            assert np.array_equal(made, expected[camera][first:first + length]), (release, camera)
    for rate, stride in ((5, 2), (2, 5)):
        pathlib.Path("slow.etl").write_text(SPEC.format(rate))
        embed("slow.etl", "--data", f"{name}:1", "--camera", TOP)
        wanted = expected[TOP][FIRST[1]:FIRST[2]:stride]
        assert np.array_equal(made_of(f"{name}-000001"), wanted), (release, stride)


def check_mixed(release, stored, expected):
    """One camera is videos, another is in the rows."""
    name = f"mixed{release[1]}"
    lerobot.write(name, release, LENGTHS, {WRIST: stored[WRIST]})
    embed("both.etl", "--data", name, "--camera", f"z={TOP}", f"w={WRIST}")
    for episode, (first, length) in enumerate(zip(FIRST, LENGTHS)):
        frames = lerobot.frames_of(name, release, LENGTHS, episode, TOP)
        crc = [zlib.crc32(frame.tobytes()) for frame in frames]
        made = np.load(f"out/{name}-{episode:06}.npz")
        assert [int(low) + (int(high) << 16) for low, high in made["z"]] == crc, release
        assert np.array_equal(made["w"], expected[WRIST][first:first + length]), release


def check_only_camera(stored, expected):
    """It needs no name; release 2.0 equals 2.1."""
    shutil.copytree("set2", "only")
    info = json.loads(pathlib.Path("only/meta/info.json").read_text())
    info["codebase_version"] = "v2.0"
    del info["features"][WRIST]
    lerobot.write_json("only/meta/info.json", info)
    embed("seen.etl", "--data", "only")
    assert np.array_equal(made_of("only-000002"), expected[TOP][FIRST[2]:])
    # A struct of bytes only, none of which may be null.
    columns, _ = lerobot.rows_of(LENGTHS)
    kind = parquet.Struct({"bytes": parquet.TEXT}, optional=False, needed=("bytes",))
    columns[TOP] = (kind, [{"bytes": image} for image in stored[TOP]])
    write_episode("only", columns, 2)
    embed("seen.etl", "--data", "only:2")
    assert np.array_equal(made_of("only-000002"), expected[TOP][FIRST[2]:])


def write_episode(folder, columns, episode, nested=()):
    part = slice(FIRST[episode], FIRST[episode] + LENGTHS[episode])
    own = {name: (kind, values[part]) for name, (kind, values) in columns.items()}
    parquet.write(f"{folder}/data/chunk-000/episode_{episode:06}.parquet", own, nested=nested)


def images_are_named(stored):
    """A defect of an image: the fourth row of an episode has it."""
    png, jpeg = stored[TOP][0], stored[WRIST][0]
    deep = image_files("deep", "png", 1, "rgb48be")[0]
    clear = image_files("clear", "png", 1, "rgba")[0]
    lerobot.call("ffmpeg", "-v", "error", "-y", "-i", "clear/001.png", "-vf",
                 "colorchannelmixer=aa=0.5", "clear/001.png.png")
    clear = pathlib.Path("clear/001.png.png").read_bytes()
    shutil.copytree("set2", "bad")
    for image, path, fault in (
            (jpeg[:-100], "a", "is cut: its end is missing"),
            (png[:len(png) // 2], "a", "is cut: its end is missing"),
            (b"no image", "a", "is no image, expected PNG or JPEG"),
            (deep, "a", "has 16 bits a channel, expected 8: save it with 8"),
            (clear, "a", "has transparent pixels, expected none: save it without"),
            (None, "images/a.png", "has no bytes and the path 'images/a.png', which is not read"),
            (b"", "images/a.png", "has no bytes and the path 'images/a.png', which is not read"),
            (None, None, "is null, expected an image"), (b"", None, "is without bytes, expected"),
            (None, "", "is null, expected an image")):
        columns, _ = lerobot.rows_of(LENGTHS, stored)
        columns[TOP][1][FIRST[1] + 3] = {"bytes": image, "path": path}
        write_episode("bad", columns, 1)
        said = embed("seen.etl", "--data", "bad", "--camera", TOP, status=1)
        place = "bad:000001: error: data/chunk-000/episode_000001.parquet: row 3 of the episode"
        assert f"{place}: {TOP}: {fault}" in said and "[E1009]" in said, (fault, said)
        assert not os.path.exists("out/bad-000001.npz"), fault
        embed("slow.etl", "--data", "bad:1", "--camera", TOP)  # a step rate that skips that row
        assert len(made_of("bad-000001")) == 2, fault
    columns[TOP][1][FIRST[1] + 3] = None
    write_episode("bad", columns, 1)
    assert f"{TOP}: is null, expected an image" in embed("seen.etl", "--data", "bad", "--camera",
                                                         TOP, status=1)


def rows_of_shared_files_are_named(stored):
    """A file of several episodes: the row counts within the episode."""
    columns, _ = lerobot.rows_of(LENGTHS, stored)
    columns[TOP][1][FIRST[1] + 3] = None
    own = {name: (kind, values[:FIRST[2]]) for name, (kind, values) in columns.items()}
    parquet.write("set3/data/chunk-000/file-000.parquet", own, page_rows=2)
    said = embed("seen.etl", "--data", "set3", "--camera", TOP, status=1)
    assert (f"set3:000001: error: data/chunk-000/file-000.parquet: row 3 of the episode: {TOP}: is "
            "null") in said, said


def columns_are_named(stored):
    """Structs that are not images."""
    text, number = parquet.TEXT, parquet.INT64
    rows = [{"bytes": image, "path": "a", "n": 1} for image in stored[TOP]]
    for kind, values, nested, fault in (
            (None, None, (), f"has no column '{TOP}.bytes', expected '{TOP}' as a struct of bytes "
             "and path"),
            (text, stored[TOP], (), f"has no column '{TOP}.bytes'"),
            (parquet.Struct({"path": text, "n": number}), rows, (), f"no column '{TOP}.bytes'"),
            (parquet.Struct({"bytes": text, "path": text}), rows, (TOP,),
             f"column '{TOP}.bytes' does not hold bytes"),
            (parquet.Struct({"bytes": number}), [{"bytes": 1}] * len(rows), (),
             f"column '{TOP}.bytes' does not hold bytes, expected '{TOP}' as a struct"),
            (parquet.Struct({"bytes": text, "path": number}),
             [{"bytes": b"a", "path": 1}] * len(rows), (),
             f"column '{TOP}.path' does not hold text, expected '{TOP}' as a struct")):
        columns, _ = lerobot.rows_of(LENGTHS)
        if kind is not None:
            columns[TOP] = (kind, values)
        write_episode("bad", columns, 1, nested)
        said = embed("seen.etl", "--data", "bad:1", "--camera", TOP, status=1)
        place = "bad:000001: error: data/chunk-000/episode_000001.parquet: "
        assert place in said and fault in said and "[E0851]" in said, (fault, said)


def numbers_in_structs_are_read():
    """They are columns too; the bytes of images are not."""
    columns, truth = lerobot.rows_of(LENGTHS)
    kind = parquet.Struct({"x": parquet.FLOAT, "name": parquet.TEXT})
    columns["pose"] = (kind, [{"x": float(x), "name": "a"} for state, _, _ in truth
                              for x in state[:, 0]])
    write_episode("bad", columns, 1)
    pathlib.Path("rows.etl").write_text("spec rows;\nrate 10 Hz;\ninput x : f32;\n"
                                        "monitor m = F x > 1;\n")
    embed("rows.etl", "--data", "bad:1", "--map", "x=pose.x")
    assert np.array_equal(made_of("bad-000001", "x"), truth[1][0][:, 0])
    for column, fault in (("pose.name", "column 'pose.name' holds text"),
                          ("pose.y", "no column 'pose.y'"), (TOP, "is a camera"),
                          ("pose", "column 'pose' has 2 fields nested in it")):
        said = embed("rows.etl", "--data", "bad:1", "--map", f"x={column}", status=1)
        assert fault in said, (column, said)


def decoders_may_fail():
    for script, code, fault in (
            (None, "E1016", "'/nowhere' cannot be run"),
            ("kill -9 $$", "E1009", "the process that read it was stopped by signal 9"),
            ("exec 0<&-; exit 3", "E1009", "the process that read it ended too soon, with exit "
             "status 3"),
            ("exit 0", "E1009", "the process that read it ended too soon, with exit status 0"),
            ("printf '\\377\\377\\377\\377\\377\\377\\377\\377'", "E1009", "ended too soon")):
        if script is not None:
            pathlib.Path("decoder.sh").write_text(f"#!/bin/sh\n{script}\n")
            os.chmod("decoder.sh", 0o755)
        decoder = "/nowhere" if script is None else os.path.abspath("decoder.sh")
        said = embed("seen.etl", "--data", "set2:0", "--camera", TOP, status=1,
                     environment=[("ETLC_EMBEDDER", decoder)])
        assert fault in said and f"[{code}]" in said, (script, said)


def main():
    pathlib.Path("see.py").write_text(CHECKSUMS)
    pathlib.Path("seen.etl").write_text(SPEC.format(10))
    pathlib.Path("both.etl").write_text(SPEC.format(10) + BOTH)
    stored = {TOP: image_files("top", "png", sum(LENGTHS)),
              WRIST: image_files("wrist", "jpg", sum(LENGTHS), "yuvj420p")}
    stored[WRIST][5] = turned(stored[WRIST][5])
    expected = {TOP: embeddings_of_files(stored[TOP], "png")}
    pixels_are_those_of_ffmpeg(expected[TOP], "top")
    expected[WRIST] = embeddings_of_files(stored[WRIST], "jpg")
    for embeddings in expected.values():
        assert len(np.unique(embeddings, axis=0)) == sum(LENGTHS), "no two images are alike"
    check_release("v2.1", stored, expected, codec=parquet.SNAPPY, page_rows=3)
    check_release("v3.0", stored, expected, codec=parquet.ZSTD, dictionary=True, version=2)
    check_mixed("v2.1", stored, expected)
    check_mixed("v3.0", stored, expected)
    check_only_camera(stored, expected)
    decoders_may_fail()
    images_are_named(stored)
    columns_are_named(stored)
    numbers_in_structs_are_read()
    rows_of_shared_files_are_named(stored)


with tempfile.TemporaryDirectory() as box:
    os.chdir(box)
    main()
    os.chdir("/")
