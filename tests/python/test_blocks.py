"""Whatever the docs say to type runs."""

from __future__ import annotations

import re
import shutil

import pages
import pytest


def name_of(page):
    return str(page.relative_to(pages.ROOT))


with_blocks = [page for page in pages.PAGES if pages.blocks(page)]


@pytest.mark.parametrize("page", with_blocks, ids=name_of)
def test_what_a_page_says_to_type_runs(page, tmp_path):
    if (
        re.search("^```(octave|matlab)", page.read_text(), re.M)
        and shutil.which("octave-cli") is None
    ):
        pytest.skip("needs Octave: apt install octave")
    said = pages.run(page, tmp_path)
    assert "QuadcoreWarning" not in said


def test_every_command_of_the_readme_flies_from_a_clone_and_leaves_what_it_says(tmp_path):
    said = pages.run(pages.README, tmp_path)
    assert "arning" not in said
    assert (tmp_path / "out" / "gusts" / "report.html").exists()
    assert (tmp_path / "out" / "hover" / "path.png").exists()
