#!/usr/bin/env python3
"""Sentences of the user's pages are short: at most 25 words. Code, tables, headings and pictures do not count.

    plain_english.py            the tests
    plain_english.py PAGE…      the long sentences of these pages, with lines and numbers of words
"""

import re
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

# Pages that have been written so. A page that joins them stays so.
PAGES = [
    "README.md",
    "docs/beams.md",
    "docs/cpp-api.md",
    "docs/faq.md",
    "docs/gallery.md",
    "docs/guide/drawings.md",
    "docs/guide/joints.md",
    "docs/guide/limits.md",
    "docs/guide/liners.md",
    "docs/guide/pictures.md",
    "docs/guide/loads.md",
    "docs/guide/results.md",
    "docs/guide/running.md",
    "docs/guide/scenarios.md",
    "docs/guide/support.md",
    "docs/index.md",
    "docs/library.md",
    "docs/python-api.md",
    "docs/python-runs.md",
    "docs/python.md",
    "docs/result-file.md",
    "docs/slopes.md",
    "docs/studies.md",
    "docs/risk.md",
    "docs/study-report.md",
    "docs/suites.md",
    "docs/user-guide.md",
    "docs/verification.md",
    "docs/vocabulary.md",
    "docs/tutorials/arch.md",
    "docs/tutorials/first-block.md",
    "docs/tutorials/masonry.md",
    "docs/tutorials/own-tunnel.md",
    "docs/tutorials/study.md",
]

MOST_WORDS = 25

FENCE = re.compile(r"^\s*(```|~~~)")
ITEM = re.compile(r"^\s*([-*+]|\d+\.)\s+")
CODE = re.compile(r"`[^`]*`")
IMAGE = re.compile(r"!\[[^\]]*\]\([^)]*\)")
LINK = re.compile(r"\[([^\]]*)\]\([^)]*\)")
END = re.compile(r"(?<=[.!?])[)\"*]*\s+(?=[\"*(]*[^\W\d_a-zαωΔ]|[\"*(]*\d|[\"*(]*CODE)")
WORD = re.compile(r"\w")


def paragraphs(text):
    """(number of the line, text) of each paragraph and item of a list, without code, tables, headings."""
    found, lines, first, fenced = [], [], 0, False

    def end():
        if lines:
            found.append((first, " ".join(lines)))
        lines.clear()

    for number, line in enumerate(text.split("\n"), 1):
        if FENCE.match(line):
            fenced = not fenced
            end()
            continue
        stripped = line.strip()
        if fenced or not stripped or stripped.startswith(("|", "#")):
            end()
            continue
        if ITEM.match(line):
            end()
            stripped = ITEM.sub("", line)
        if not lines:
            first = number
        lines.append(stripped)
    end()
    return found


def sentences(paragraph):
    text = LINK.sub(r"\1", IMAGE.sub("", CODE.sub("CODE", paragraph)))
    return [sentence for sentence in END.split(text) if sentence.strip()]


def words(sentence):
    return sum(1 for word in sentence.split() if WORD.search(word))


def long_sentences(text, most=MOST_WORDS):
    """(line, number of words, sentence) of those that are too long."""
    for line, paragraph in paragraphs(text):
        for sentence in sentences(paragraph):
            if words(sentence) > most:
                yield line, words(sentence), sentence


class Pages(unittest.TestCase):
    def test_sentences_are_short(self):
        for page in PAGES:
            with self.subTest(page):
                found = [f"{page}:{line}: {count} words: {text}" for line, count, text in long_sentences((ROOT / page).read_text())]
                self.assertEqual(found, [], "\n".join(found))


class Checker(unittest.TestCase):
    def counts(self, text):
        return [words(sentence) for _, paragraph in paragraphs(text) for sentence in sentences(paragraph)]

    def test_words_and_sentences(self):
        self.assertEqual(self.counts("One two three.\nFour five – six! Seven?"), [3, 3, 1])

    def test_numbers_and_signs_do_not_end_a_sentence(self):
        self.assertEqual(self.counts("It takes 0.002 s, i.e. little, as `a. B` says."), [9])

    def test_what_does_not_count(self):
        self.assertEqual(self.counts("# A heading\n| a | table |\n```toml\na = 1\n```\n![A picture of it.](a.svg)\n"), [])

    def test_code_and_links_are_words(self):
        self.assertEqual(self.counts("Take `keyblock run x -o y` or [this page here](a.md#b)."), [6])

    def test_items_of_lists_are_sentences(self):
        self.assertEqual(self.counts("- one two\n  three\n- four\n1. five six\n"), [3, 1, 2])

    def test_bold_beginnings(self):
        self.assertEqual(self.counts("**Never.** It is so. **Always** it is. *Well.* `x` is so."), [1, 3, 3, 1, 3])

    def test_long_ones_are_found(self):
        long = " ".join(["word"] * 26)
        self.assertEqual([(line, count) for line, count, _ in long_sentences(f"Short.\n\n{long}. Short.")], [(3, 26)])


if __name__ == "__main__":
    if len(sys.argv) > 1:
        total = 0
        for name in sys.argv[1:]:
            for line, count, text in long_sentences(Path(name).read_text()):
                print(f"{name}:{line}: {count} words: {text}")
                total += 1
        sys.exit(1 if total else 0)
    unittest.main()
