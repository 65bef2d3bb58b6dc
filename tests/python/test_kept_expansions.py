"""An expanded xacro is kept while nothing changes that it was made of."""

import os
from pathlib import Path

import pytest
import xacro

import quadcore as qc
from quadcore.model.xacro_expansion import expand

MODEL = """<robot name="kept" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:arg name="k" default="1"/>
<xacro:include filename="part.xacro"/>
<xacro:include filename="maybe.xacro" optional="true"/>
<xacro:include filename="more/*.xacro"/>
<xacro:property name="table" value="${xacro.load_yaml('table.yaml')}"/>
<a k="$(arg k)" mass="${table['mass']}" place="$(optenv PLACE here)"/>
</robot>
"""


def part(text):
    return f'<robot xmlns:xacro="http://www.ros.org/wiki/xacro">{text}</robot>'


@pytest.fixture
def expanded(tmp_path, monkeypatch):
    """Expand the model; `expanded.count` says how often xacro did."""
    folder = tmp_path / "model"
    (folder / "more").mkdir(parents=True)
    monkeypatch.chdir(folder)
    monkeypatch.delenv("PLACE", raising=False)
    Path("kept.xacro").write_text(MODEL)
    Path("part.xacro").write_text(part("<b/>"))
    Path("more/one.xacro").write_text(part("<one/>"))
    Path("table.yaml").write_text("mass: 1.5\n")
    process_file = xacro.process_file

    def count_expansion(*arguments, **options):
        text.count += 1
        return process_file(*arguments, **options)

    def text(**arguments):
        return "".join(line for line, _ in expand("kept.xacro", arguments))

    text.count = 0
    monkeypatch.setattr(xacro, "process_file", count_expansion)
    return text


def test_it_is_expanded_once_while_nothing_changes(expanded):
    first = expanded()
    assert first == '<robot name="kept"><b/><one/><a k="1" mass="1.5" place="here"/></robot>'
    assert [expanded(), expanded()] == [first, first]
    assert expanded.count == 1


@pytest.mark.parametrize(
    ("name", "text", "seen"),
    [
        ("kept.xacro", MODEL.replace("<a k", "<c k"), "<c k="),
        ("part.xacro", part("<d/>"), "<d/>"),
        ("maybe.xacro", part("<e/>"), "<e/>"),
        ("more/two.xacro", part("<two/>"), "<one/><two/>"),
        ("table.yaml", "mass: 2.5\n", 'mass="2.5"'),
    ],
)
def test_it_is_expanded_again_when_a_file_changes(expanded, name, text, seen):
    assert seen not in expanded()
    before = os.stat(name) if Path(name).exists() else None
    Path(name).write_text(text)
    if before:  # an edit that neither the time nor the size of the file betrays
        os.utime(name, ns=(before.st_atime_ns, before.st_mtime_ns))
    assert seen in expanded()
    assert expanded.count == 2


def test_it_is_expanded_again_for_other_arguments_folders_and_environments(
    expanded, monkeypatch, tmp_path
):
    expanded()
    assert 'k="2"' in expanded(k="2")
    monkeypatch.setenv("PLACE", "there")
    assert 'place="there"' in expanded()
    monkeypatch.delenv("PLACE")
    assert 'place="here"' in expanded()
    (tmp_path / "kept.xacro").write_text(part("<other/>"))
    monkeypatch.chdir(tmp_path)
    assert "<other/>" in expanded()


def test_what_may_be_another_each_time_or_warns_is_not_kept(expanded):
    Path("kept.xacro").write_text(MODEL.replace("</robot>", '<f n="$(eval 1 + 1)"/></robot>'))
    expanded()
    assert '<f n="2"/>' in expanded()
    assert expanded.count == 2
    Path("kept.xacro").write_text(MODEL.replace("more/*", "nowhere/*"))
    for _ in range(2):
        with pytest.warns(qc.QuadcoreWarning, match="matched no files"):
            expanded()


def test_an_unknown_argument_is_refused_each_time(expanded):
    for _ in range(2):
        with pytest.raises(qc.InputError, match=r"no xacro argument 'kk'.*Use one of k"):
            expanded(kk="1")
    assert expanded.count == 1


def test_a_file_that_vanishes_is_missed(expanded):
    expanded()
    Path("part.xacro").unlink()
    with pytest.raises(qc.InputError, match=r"part\.xacro"):
        expanded()
