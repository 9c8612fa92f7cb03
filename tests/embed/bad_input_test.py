"""bad_input_test.py ETLC: images and videos that are damaged, cut, or ambiguous are refused by
name, and nothing is written; only the program for video loads FFmpeg; other encodings of the same
image give the same frames; late frames of a video equal those of a full decode."""
import itertools
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

import numpy as np
from PIL import Image, ImageOps, PngImagePlugin

ETLC = os.path.abspath(sys.argv[1])
EMBEDDER = os.path.join(os.path.dirname(ETLC), "etlc-embed")
random = np.random.default_rng(5)


def call(*words, status=0, given=None):
    done = subprocess.run(words, capture_output=True, input=given)
    assert done.returncode == status, (words, done.returncode, done.stderr)
    return done.stdout, done.stderr.decode()


def frames_of(data):
    frames = []
    while data:
        height, width = struct.unpack("<II", data[:8])
        size = height * width * 3
        frames.append(np.frombuffer(data[8 : 8 + size], np.uint8).reshape(height, width, 3))
        data = data[8 + size :]
    return frames


def sized(*paths):
    """What etlc-embed reads if images are not files."""
    parts = [pathlib.Path(path).read_bytes() for path in paths]
    return b"".join(struct.pack("<I", len(part)) + part for part in parts)


def images(*paths):
    found = call(EMBEDDER, "images", *paths)[0]
    assert call(EMBEDDER, "given", given=sized(*paths))[0] == found, paths
    return frames_of(found)


def video(path, *options):
    return frames_of(call(EMBEDDER, "video", path, *map(str, options))[0])


def refused(words, fault, status=65):
    out, said = call(EMBEDDER, *map(str, words), status=status)
    assert said.count("\n") == 1 and fault in said, (words, fault, said)
    return frames_of(out)


def noise(*shape, most=256):
    return random.integers(0, most, shape, np.uint16 if most > 256 else np.uint8)


def only_video_loads_ffmpeg():
    loaded = call("ldd", EMBEDDER)[0].decode()
    assert "libpng" in loaded and "libav" not in loaded, loaded
    assert "libavcodec" in call("ldd", EMBEDDER + "-video")[0].decode()
    os.mkdir("alone")
    shutil.copy(EMBEDDER, "alone/etlc-embed")
    out, said = call("alone/etlc-embed", "video", "any.mp4", status=65)
    assert not out and "alone/etlc-embed-video, which decodes video, cannot be run" in said, said


def other_forms_say_the_same():
    colour, grey = noise(7, 5, 3), noise(7, 5)
    opaque = np.dstack([colour, np.full((7, 5), 255, np.uint8)])
    few = Image.fromarray(colour // 64 * 64).quantize(64)
    same = {
        "colour.png": (Image.fromarray(colour), colour),
        "opaque.png": (Image.fromarray(opaque, "RGBA"), colour),
        "grey.png": (Image.fromarray(grey), np.dstack([grey] * 3)),
        "grey_opaque.png": (Image.merge("LA", [Image.fromarray(grey), Image.new("L", (5, 7), 255)]),
                            np.dstack([grey] * 3)),
        "palette.png": (few, np.asarray(few.convert("RGB"))),
        "two.png": (Image.fromarray(grey > 99), np.dstack([(grey > 99) * np.uint8(255)] * 3)),
        "tall.png": (Image.fromarray(noise(40, 1, 3)), None),
    }
    for name, (image, expected) in same.items():
        image.save(name)
        expected = np.asarray(image) if expected is None else expected
        assert (images(name)[0] == expected).all(), name
    call("ffmpeg", "-v", "error", "-i", "colour.png", "-flags", "+ildct", "woven.png")
    assert pathlib.Path("woven.png").read_bytes()[28] == 1, "its rows are interlaced"
    gamma = PngImagePlugin.PngInfo()
    gamma.add(b"gAMA", struct.pack(">I", 22222))
    Image.fromarray(colour).save("gamma.png", pnginfo=gamma)
    for name in ("woven.png", "gamma.png"):
        assert (images(name)[0] == colour).all(), name
    for number in range(40):
        shape = (*random.integers(1, 40, 2), 3)
        image = Image.fromarray(noise(*shape) // (1 if number % 2 else 32))
        image = image.convert("L") if number % 5 == 0 else image
        image.save("any.jpg", quality=int(random.integers(5, 96)), progressive=number % 3 == 0,
                   subsampling=number % 3)
        expected = np.asarray(Image.open("any.jpg").convert("RGB"))
        assert (images("any.jpg")[0] == expected).all(), (number, shape)
    both = images("colour.png", "tall.png")  # of different sizes
    assert [frame.shape for frame in both] == [(7, 5, 3), (40, 1, 3)]


def orientations_are_applied():
    for ending, orientation in itertools.product(("jpg", "png"), range(10)):
        exif = Image.Exif()
        exif[0x0112] = orientation
        Image.fromarray(noise(21, 34, 3)).save(f"turned.{ending}", exif=exif)
        expected = np.asarray(ImageOps.exif_transpose(Image.open(f"turned.{ending}")))
        found = images(f"turned.{ending}")[0]
        assert found.shape == expected.shape and (found == expected).all(), (ending, orientation)


def chunk(name, data):
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def large_images(width, height):
    """Headers of images that declare this many pixels."""
    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    png = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(b"\0"))
    jpeg = bytearray(pathlib.Path("whole.jpg").read_bytes())
    at = jpeg.index(b"\xff\xc0") + 5
    jpeg[at : at + 4] = struct.pack(">HH", height, width)
    for name, data in (("large.png", png), ("large.jpg", jpeg)):
        pathlib.Path(name).write_bytes(data)
        yield name


def images_are_refused():
    Image.fromarray(noise(4, 4, most=65536)).save("deep_grey.png")
    call("ffmpeg", "-v", "error", "-f", "lavfi", "-i", "testsrc2=size=16x16", "-frames:v", "1",
         "-pix_fmt", "rgb48be", "deep.png")
    half = np.dstack([noise(4, 4, 3), np.full((4, 4), 128, np.uint8)])
    Image.fromarray(half, "RGBA").save("half.png")
    Image.fromarray(noise(4, 4)).quantize(8).save("hole.png", transparency=0)
    Image.fromarray(noise(64, 64, 3)).save("whole.png")
    Image.fromarray(noise(64, 64, 3)).save("whole.jpg")
    for ending in ("png", "jpg"):
        whole = pathlib.Path(f"whole.{ending}").read_bytes()
        pathlib.Path(f"cut.{ending}").write_bytes(whole[: len(whole) * 2 // 3])
    whole = bytearray(pathlib.Path("whole.png").read_bytes())
    whole[len(whole) // 2] ^= 255
    pathlib.Path("changed.png").write_bytes(whole)
    Image.fromarray(noise(8, 8, 4), "CMYK").save("print.jpg")
    jpeg = bytearray(pathlib.Path("whole.jpg").read_bytes())
    jpeg[-40:-38] = b"\xff\xd9"  # an end marker before the end
    pathlib.Path("short.jpg").write_bytes(jpeg)
    pathlib.Path("empty.png").write_bytes(b"")
    pathlib.Path("text.png").write_text("no image\n")
    Image.fromarray(noise(4, 4, 3)).save("other.bmp")
    os.rename("other.bmp", "other.png")
    os.mkdir("folder.png")
    os.mkfifo("pipe.png")
    for width, height in ((60000, 60000), (16385, 1), (1, 16385), (16384, 4097)):
        for name in large_images(width, height):
            refused(["images", name], f"has {width} x {height} pixels, expected at most 16384 in a "
                    "row or column and 67108864 in all")
    for name, fault in (("deep_grey.png", "16 bits a channel"), ("deep.png", "16 bits a channel"),
                        ("half.png", "transparent"), ("hole.png", "transparent"),
                        ("cut.png", "is cut"), ("cut.jpg", "is cut"), ("changed.png", "is damaged"),
                        ("short.jpg", "is damaged"), ("print.jpg", "CMYK"),
                        ("other.png", "is no image, expected PNG or JPEG"),
                        ("empty.png", "empty"), ("text.png", "no image"),
                        ("folder.png", "cannot be read"), ("none.png", "cannot be read"),
                        ("pipe.png", "cannot be read as a file")):
        given = refused(["images", "colour.png", name], fault)
        assert len(given) == 1, "the image before is whole"
        if os.path.isfile(name):
            out, said = call(EMBEDDER, "given", status=65, given=sized("colour.png", name))
            assert fault in said.splitlines()[-1] and len(frames_of(out)) == 1, (name, said)
    for rest, status, words in ((b"\xff" * 4, 65, "has 4294967295 bytes, at most 67108864 are"),
                                (struct.pack("<I", 9), 64, "ends in an image"),
                                (struct.pack("<I", 9) + b"image", 64, "standard input ends in"),
                                (b"\x09\0", 64, "standard input ends in")):
        out, said = call(EMBEDDER, "given", status=status, given=sized("colour.png") + rest)
        assert words in said and len(frames_of(out)) == 1, (rest, said)
    assert call(EMBEDDER, "given", given=b"")[0] == b""


def make_video(path, *options, frames=24, size="32x32"):
    call("ffmpeg", "-v", "error", "-y", "-f", "lavfi", "-i", f"testsrc2=size={size}:rate=10",
         "-frames:v", str(frames), "-pix_fmt", "yuv420p", *options, path)
    return bytearray(pathlib.Path(path).read_bytes())


def videos_are_refused():
    h264 = ["-c:v", "libx264", "-g", "8"]
    for path, options in (("v.mp4", h264), ("fast.mp4", [*h264, "-movflags", "+faststart"]),
                          ("v.mov", h264), ("v.mkv", h264), ("v.avi", ["-c:v", "mpeg4"]),
                          ("v.webm", ["-c:v", "libvpx-vp9", "-deadline", "realtime"]),
                          ("v.gif", ["-pix_fmt", "rgb8"])):
        whole = make_video(path, *options)
        assert len(video(path)) == 24, path
        for less in [len(whole) // 3] + [1] * (path in ("v.mkv", "v.webm", "v.gif")):
            pathlib.Path("cut_" + path).write_bytes(whole[:-less])
            _, said = call(EMBEDDER, "video", "cut_" + path, status=65)
            assert any(word in said for word in ("cut", "damaged", "no frame")), (path, less, said)
    # The header of an .avi and a tag of an .mkv declare more frames than the file has.
    whole = pathlib.Path("v.avi").read_bytes()
    at = whole.index(b"strh") + 8 + 32
    assert struct.unpack("<I", whole[at : at + 4]) == (24,)
    pathlib.Path("more.avi").write_bytes(whole[:at] + struct.pack("<I", 70) + whole[at + 4 :])
    refused(["video", "more.avi"], "promises 70 frames and holds 24")
    call("ffmpeg", "-v", "error", "-i", "v.mkv", "-c", "copy", "-metadata:s:v",
         "NUMBER_OF_FRAMES=25", "more.mkv")
    refused(["video", "more.mkv"], "promises 25 frames and holds 24")
    refused(["video", "v.mp4", "--only", "3,24"], "has 24 frames; there is no frame 24", 67)
    refused(["video", "v.mp4", "--first", 20, "--count", 5], "there is no frame 24", 67)
    for ending in ("mp4", "mkv"):
        call("ffmpeg", "-v", "quiet", "-f", "lavfi", "-i", "testsrc2=size=64x48", "-frames:v", "0",
             f"none.{ending}")
        said = call(EMBEDDER, "video", f"none.{ending}", status=65)[1]
        assert "no frame" in said or "no video" in said, said
    pathlib.Path("empty.mp4").write_bytes(b"")
    pathlib.Path("text.mp4").write_text("no video\n")
    for name in ("empty.mp4", "text.mp4", "none_at_all.mp4"):
        refused(["video", name], "is no video")
    call("ffmpeg", "-v", "error", "-f", "lavfi", "-i", "sine", "-t", "1", "sound.mp4")
    refused(["video", "sound.mp4"], "holds no video")


def lost_frames_are_refused():
    """One frame lost of 400 hardly changes the average rate."""
    for lost, words in ((200, "has frame 200 0.2 s after the one before, expected 0.1"),
                        (400, "")):
        call("ffmpeg", "-v", "error", "-y", "-f", "lavfi", "-i", "testsrc2=size=16x16:rate=10",
             "-frames:v", "399", "-vf", f"select=not(eq(n\\,{lost}))", "-fps_mode", "passthrough",
             "-c:v", "libx264", "lost.mkv")
        for options in ([], ["--first", 190, "--count", 30]):
            if words:
                refused(["video", "lost.mkv", "--rate", 10, *options], words, 66)
            else:
                assert len(video("lost.mkv", "--rate", 10, *options)) == (30 if options else 399)
        assert len(video("lost.mkv")) == 399


def late_frames_are_those_of_all():
    h264 = ["-c:v", "libx264", "-g", "20"]
    # So narrow a picture is refreshed in two steps; its encoder says that one is enough.
    narrow = [*h264, "-bf", "0", "-x264-params", "intra-refresh=1"]
    hevc = ["-s", "64x64", "-c:v", "libx265", "-g", "20", "-x265-params"]
    kinds = (("late.mp4", h264), ("late.ts", h264),
             ("open.mkv", [*h264, "-x264-params", "open-gop=1:bframes=3"]),
             ("refresh.mkv", [*h264, "-x264-params", "intra-refresh=1"]),
             ("narrow.mkv", narrow), ("narrow.mp4", narrow), ("narrow.ts", narrow),
             ("leading.ts", [*hevc, "log-level=none:open-gop=1:bframes=3"]),
             ("leading.mkv", [*hevc, "log-level=none:open-gop=1:bframes=3"]),
             ("old.avi", ["-c:v", "mpeg4", "-bf", "2", "-g", "20"]),
             ("late.webm", ["-c:v", "libvpx-vp9", "-deadline", "realtime", "-cpu-used", "8", "-g",
                            "20", "-auto-alt-ref", "1", "-lag-in-frames", "16"]),
             ("hidden.webm", ["-c:v", "libvpx", "-deadline", "realtime", "-g", "20",
                              "-auto-alt-ref", "1", "-lag-in-frames", "16"]))
    wanted = [3, 79, 80, 81, 137, 139]
    for path, options in kinds:
        make_video(path, *options, frames=140)
        every = video(path)
        assert len(every) == 140, path
        some = video(path, "--only", ",".join(map(str, wanted)))
        assert len(some) == len(wanted), path
        assert all((a == every[n]).all() for a, n in zip(some, wanted)), path
        part = video(path, "--first", 60, "--count", 3, "--total", 140)
        assert len(part) == 3 and all((a == b).all() for a, b in zip(part, every[60:])), path
        for total in (139, 141):
            refused(["video", path, "--first", 60, "--count", 3, "--total", total],
                    f"has 140 frames, expected the {total}", 69)
        if path == "late.mp4":
            of_late = every
    every = of_late
    end = video("late.mp4", "--first", 120)
    assert len(end) == 20 and all((a == b).all() for a, b in zip(end, every[120:]))
    part = video("late.mp4", "--first", 93, "--count", 9)
    assert len(part) == 9 and all((a == b).all() for a, b in zip(part, every[93:]))
    assert len(video("late.mp4", "--first", 120, "--rate", 5)) == 10
    every_second = video("late.mp4", "--rate", 5)
    part = video("late.mp4", "--rate", 5, "--skip", 47)
    assert len(part) == 23 and all((a == b).all() for a, b in zip(part, every_second[47:]))
    refused(["video", "late.mp4", "--first", 135, "--count", 9], "there is no frame 143", 67)
    # Data before the key frame are not decoded, and may be damaged.
    packets = call("ffprobe", "-v", "error", "-select_streams", "v", "-show_entries",
                   "packet=pos,size", "-of", "csv=p=0", "late.mp4")[0].split()
    whole = bytearray(pathlib.Path("late.mp4").read_bytes())
    sizes = {position: size for size, position in (map(int, row.split(b",")) for row in packets)}
    for position in sorted(sizes)[10:30]:
        start, end = position + 5, position + sizes[position]
        whole[start:end] = bytes(end - start)
    pathlib.Path("damaged.mp4").write_bytes(whole)
    assert (video("damaged.mp4", "--only", 110)[0] == every[110]).all()
    refused(["video", "damaged.mp4"], "damaged")


def transport_streams_are_read_where_they_are_whole():
    """Streams may be joined, or begin anywhere; of lost packets nothing is made up."""
    packet, video_id = 188, 0x100
    for path, options in (("stream.ts", ["-c:v", "libx264", "-g", "12"]),
                          ("hevc.ts", ["-s", "64x64", "-c:v", "libx265", "-g", "12",
                                       "-x265-params", "log-level=none"])):
        whole = make_video(path, *options, frames=36)
        every = np.array(video(path))
        packets = [whole[at : at + packet] for at in range(0, len(whole), packet)]
        ours = [n for n, one in enumerate(packets) if (one[1] & 31) << 8 | one[2] == video_id]
        pictures = [i for i, n in enumerate(ours) if packets[n][1] & 64] + [len(ours)]

        def written(some):
            pathlib.Path("part.ts").write_bytes(b"".join(some))
            return "part.ts"

        # A recording that began while the stream was running.
        part = np.array(video(written(packets[ours[pictures[5]] + 1 :])))
        assert len(part) in (12, 24) and (part == every[-len(part):]).all(), (path, len(part))
        # Joined streams, whose time begins again.
        both = np.array(video(written(packets + packets)))
        assert (both == np.concatenate([every, every])).all(), path
        some = video("part.ts", "--only", "3,40,71")
        assert all((a == both[n]).all() for a, n in zip(some, (3, 40, 71))), path
        refused(["video", "part.ts", "--rate", 10], "not evenly spaced", 66)
        # Lost packets: the last one of a picture, all of one, and the same before a key frame.
        for first, end in itertools.pairwise(pictures[10:14]):
            for lost in (ours[end - 1 : end], ours[first:end]):
                kept = [one for n, one in enumerate(packets) if n not in lost]
                said = call(EMBEDDER, "video", written(kept), status=65)[1]
                assert "damaged" in said, (path, lost, said)
    call("ffmpeg", "-v", "error", "-i", "stream.ts", "-c", "copy", "-f", "segment",
         "-segment_time", "1.2", "segment%d.ts")
    segments = b"".join(pathlib.Path(f"segment{n}.ts").read_bytes() for n in range(3))
    pathlib.Path("part.ts").write_bytes(segments)
    assert (np.array(video("part.ts", "--rate", 10)) == np.array(video("stream.ts"))).all()


def what_is_whole_is_written():
    pathlib.Path("t.etl").write_text("""spec t;
rate 10 Hz;
encoder net = load("net.onnx"), image [8, 8];
input z : f32[4] by net;
target bay = images("colour.png"), frames("v.mp4", [3]) by net;
monitor m = F min l2(z, bay) <= 1;
""")
    pathlib.Path("net.onnx").write_text("for a command\n")
    row = struct.pack("<4f", 1, 2, 3, 4)
    pathlib.Path("encode.py").write_text(f"""import struct, sys
sys.stdout.buffer.write(struct.pack("<I", 4))
while head := sys.stdin.buffer.read(8):
    height, width = struct.unpack("<II", head)
    sys.stdin.buffer.read(3 * height * width)
    sys.stdout.buffer.write({row!r})
""")
    good = ["--encoder-cmd", "/usr/bin/python3 encode.py"]
    os.mkdir("mixed")
    for name in ("colour.png", "half.png"):
        os.link(name, f"mixed/{name}")
    for data, words in (("cut_v.mkv", ["E1010", "cut_v.mkv", "is cut"]),
                        ("mixed", ["E1009", "mixed/half.png", "transparent"]),
                        ("more.avi", ["E1010", "promises 70"]),
                        ("none.mp4", ["E1010", "no"]), ("sound.mp4", ["E1010", "no video"])):
        said = call(ETLC, "embed", "t.etl", "--data", "v.mp4", data, "-o", "out", *good,
                    status=1)[1]
        assert all(word in said for word in words), (data, said)
        assert os.listdir("out") == ["v.npz"] and not os.path.exists("t.embedded.npz"), data
        assert np.load("out/v.npz")["z"].shape == (24, 4), "the episode before it is whole"
        os.remove("out/v.npz")
    # Commands that exit or hang while a pipe holds less than the remaining input.
    make_video("large.mp4", "-c:v", "libx264", frames=20, size="640x480")
    for command, wait, words in (("exit 3", "250", ["exit status 3"]),
                                 ("sleep 250", "1", ["said nothing for 1"]),
                                 ("head -c 100000 > /dev/null; exit 4", "250", ["exit status 4"]),
                                 ("exec 0<&-; sleep 250", "1", ["'net'"]),
                                 ("cat", "250", ["dimension"]), ("yes", "250", ["dimension"]),
                                 ("printf '\\001\\000\\000\\000'; cat > /dev/null", "250",
                                  ["dimension 1, the inputs by it have 4"])):
        said = call(ETLC, "embed", "t.etl", "--data", "large.mp4", "-o", "out", "--encoder-cmd",
                    command, "--encoder-timeout", wait, status=1)[1]
        assert all(word in said for word in words) and "E101" in said, (command, said)
        assert not os.listdir("out") and not os.path.exists("t.embedded.npz"), command
    call(ETLC, "embed", "t.etl", "--data", "v.mp4", "-o", "out", *good)
    assert np.load("out/v.npz")["z"].shape == (24, 4)


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    only_video_loads_ffmpeg()
    other_forms_say_the_same()
    orientations_are_applied()
    images_are_refused()
    videos_are_refused()
    lost_frames_are_refused()
    late_frames_are_those_of_all()
    transport_streams_are_read_where_they_are_whole()
    what_is_whole_is_written()
    os.chdir("/")
