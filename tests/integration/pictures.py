#!/usr/bin/env python3
"""`keyblock picture` and `keyblock film`: files of the right kind, and what they say where a tool is missing."""

import os
import re
import shutil
import struct
import subprocess
import unittest
import xml.etree.ElementTree as ET

from program import PROGRAM, Scenario


class Pictures(Scenario):
    def setUp(self):
        super().setUp()
        self.keyblock("run", "incline.toml", "-o", "out")

    def read(self, name):
        return (self.folder / name).read_bytes()

    def test_an_svg_whose_name_says_what_it_is(self):
        self.keyblock("picture", "out", "--time", "0.5")
        svg = self.read("out/a-block-on-an-incline-displacement-0.500s.svg").decode()
        root = ET.fromstring(svg)
        texts = [t.text for t in root.iter("{http://www.w3.org/2000/svg}text")]
        self.assertIn("A block on an incline", texts)
        self.assertIn("slide, t = 0.500 s", texts)
        # It slides by g (sin 30° − cos 30° tan 20°) t²/2 = 0.4532 m, so the scale ends at the next round number.
        self.assertIn("500\u00a0mm", texts)

    def test_a_later_moment_lies_farther_down(self):
        places = []
        for name, time in (("a.svg", "0"), ("b.svg", "0.5")):
            self.keyblock("picture", "out", "--color", "plain", "--time", time, "-o", name)
            drawn = re.search(r'<path fill="#e4e1d8" d="M([\d.]+) ([\d.]+)', self.read(name).decode())
            places.append([float(v) for v in drawn.groups()])
        self.assertGreater(places[1][1], places[0][1] + 10.0)
        self.assertGreater(places[1][0], places[0][0] + 10.0)

    @unittest.skipUnless(shutil.which("rsvg-convert"), "librsvg2-bin is not installed")
    def test_pdf_and_png(self):
        self.keyblock("picture", "out", "-o", "a.pdf")
        self.assertEqual(self.read("a.pdf")[:5], b"%PDF-")
        self.keyblock("picture", "out", "--forces", "--stress", "-o", "a.png")
        width, _ = struct.unpack(">II", self.read("a.png")[16:24])
        self.assertEqual(width, 3 * 1280)

    @unittest.skipUnless(shutil.which("ffmpeg"), "ffmpeg is not installed")
    def test_a_film_of_all_frames(self):
        said = self.keyblock("film", "out", "-o", "fall.mp4").stdout
        frames = int(re.search(r"film of (\d+) frames", said)[1])
        self.assertEqual(self.read("fall.mp4")[4:8], b"ftyp")
        count = ["ffprobe", "-v", "error", "-count_frames", "-select_streams", "v", "-show_entries", "stream=nb_read_frames", "-of", "csv=p=0"]
        done = subprocess.run([*count, "fall.mp4"], cwd=self.folder, capture_output=True, text=True, check=True)
        self.assertEqual(int(done.stdout.strip().strip(",")), frames)
        self.assertEqual([p.name for p in self.folder.iterdir() if p.name.startswith("fall.")], ["fall.mp4"], "nothing is left over")

    def test_what_is_missing_is_told(self):
        for words, tool in ((("picture", "out", "-o", "a.pdf"), "librsvg2-bin"), (("film", "out", "-o", "a.mp4"), "apt-get install ffmpeg")):
            done = subprocess.run([PROGRAM, *words], cwd=self.folder, capture_output=True, text=True, env={**os.environ, "PATH": "/nowhere"})
            self.assertEqual(done.returncode, 1, done.stderr)
            self.assertIn(tool, done.stderr)

    def test_mistakes(self):
        self.assertIn("a name that ends in .svg", self.keyblock("picture", "out", "-o", "a.jpg", expect=1).stderr)
        self.assertIn("'displacment'", self.keyblock("picture", "out", "--color", "displacment", expect=1).stderr)
        self.assertIn("which ends at 0.5 s", self.keyblock("picture", "out", "--time", "3", expect=1).stderr)
        self.assertIn("a stage that has begun: \"slide\"", self.keyblock("picture", "out", "--stage", "fall", expect=1).stderr)
        self.assertIn("result.h5", self.keyblock("picture", ".", expect=1).stderr)
        self.assertIn(".mp4, .webm or .gif", self.keyblock("film", "out", "-o", "a.avi", expect=1).stderr)


if __name__ == "__main__":
    unittest.main()
