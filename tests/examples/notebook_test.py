#!/usr/bin/python3
"""notebook_test.py FOLDER: the notebook of examples/python runs, and its outputs show what its text
says."""

import base64
import io
import json
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

FOLDER = Path(sys.argv[1])


def executed(box):
    shutil.copytree(FOLDER, box / "python")
    subprocess.run(
        [sys.executable, "-B", "-m", "nbconvert", "--to", "notebook", "--execute",
         "rollouts.ipynb", "--output", "done.ipynb"],
        cwd=box / "python", check=True, capture_output=True,
    )  # fmt: skip
    return json.loads((box / "python" / "done.ipynb").read_text())


def shown(cell, kind):
    """Returns what a cell shows as text/html, image/png, ... or prints."""
    texts = []
    for output in cell["outputs"]:
        assert output["output_type"] != "error", output
        data = output.get("data", {"text/plain": output.get("text", "")})
        if kind in data:
            text = data[kind]
            texts.append(text if isinstance(text, str) else "".join(text))
    return "\n".join(texts)


def main():
    source = json.loads((FOLDER / "rollouts.ipynb").read_text())
    assert all(not cell.get("outputs") for cell in source["cells"]), "it is kept without outputs"
    with tempfile.TemporaryDirectory() as box:
        cells = [one for one in executed(Path(box))["cells"] if one["cell_type"] == "code"]
    opened, episode, step, why, frame, figure, plans, slowest, judged, ran = cells

    html = shown(opened, "text/html")
    assert "G (closed -&gt; at_goal)" in html and "float32[2]" in html, html
    html = shown(episode, "text/html")
    row = re.search(r"<td[^>]*>careful</td><td[^>]*>(\d+)</td>", html)
    assert row and row[1] == "12", html  # 1.2 s at 10 Hz
    assert html.count('class="line"') == 4 and html.count('class="threshold"') == 4, html
    assert 'class="violated"' in html and "time, s" in html and "nan" not in html, html
    assert "violated for good" in shown(step, "text/html")
    text = shown(why, "text/html")
    assert text.startswith("<pre>careful = G (closed -&gt; at_goal)\nafter step 12"), text
    assert "distance_at_goal" in shown(frame, "text/html")
    picture = Image.open(io.BytesIO(base64.b64decode(shown(figure, "image/png")))).convert("RGB")
    colours = {colour for _, colour in picture.getcolors(1 << 20)}
    assert (0xD5, 0x5E, 0x00) in colours and (0x0B, 0x4F, 0x7C) in colours, len(colours)
    assert "50 x 30 verdicts" in shown(plans, "text/html")
    # The goal begins at 0.75, and step 20 is the last in time.
    text = shown(slowest, "text/plain").strip()
    assert text == "plans from 0.038 a step on arrive in time", text
    rows = re.findall(r"<tr>.*?</tr>", shown(judged, "text/html"))
    assert len(rows) == 1 + 2 + 4, rows
    html = shown(ran, "text/html")
    assert html.startswith("<pre>careful: violated for good from step") and "time, s" in html, html
    print(f"{len(cells)} cells")


if __name__ == "__main__":
    main()
