"""Whatever the docs say to type runs."""

from __future__ import annotations

import re
import shutil

import pages
import pytest
from printed import check_printed


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


@pytest.mark.parametrize("printed", ["mass   1.01 kg\nleft out\n", "mass 0.99 kg\n3 rows\n"])
def test_shown_numbers_may_differ_by_the_tolerance(printed):
    check_printed("mass  1.000 kg\n...\n", printed, 0.02)


@pytest.mark.parametrize(
    "printed", ["mass 1.03 kg\nend\n", "mass 1.00 g\nend\n", "mass 1.00 kg\n", "a mass 1.00 kg\n\n"]
)
def test_other_words_and_numbers_are_no_shown_output(printed):
    with pytest.raises(AssertionError, match="the page shows"):
        check_printed("mass  1.000 kg\n...\n", printed, 0.02)
