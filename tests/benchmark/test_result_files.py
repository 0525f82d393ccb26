"""Problem and result files: writing overwrites nothing, and reading works as documented."""

import os
import shutil
from pathlib import Path

import numpy as np
import pytest
from oracles.limits import files_of_at_most
from oracles.simulators import write_states
from rolling_ellipse import benchmark

IDS = [one.id for one in benchmark.problems()]


def test_exact_answers_in_files_are_right_and_missing_times_are_counted(tmp_path: Path) -> None:
    """The numbers have 17 digits. The columns vx and vz are synonyms of x_dot and z_dot."""
    benchmark.export(tmp_path)
    assert [len([*tmp_path.glob(f"*.{kind}")]) for kind in ("json", "sdf", "xml")] == [20, 18, 17]
    assert {s.answer for s in benchmark.score(tmp_path)} == {"not supported"}
    for one in benchmark.problems():
        t = one.output_times[: 51 if one.id == "roll.rock" else None]
        write_states(tmp_path, one, one.exact(t), header="t,x,z,theta,vx,vz,omega")
    benchmark.export(tmp_path)  # leaves result files unchanged
    (tmp_path / "roll.thin.csv").write_text("")
    scores = benchmark.score(tmp_path)
    unlike = [(score.problem, score.answer) for score in scores if not score.passed]
    assert unlike == [("roll.rock", "failed"), ("roll.thin", "not supported")]
    short = scores[IDS.index("roll.rock")]
    assert scores.wrong == ["roll.rock"] and short.digits > 12
    assert short.reason == "ends at 0.5 s; 39 of 41 given times are missing"
    assert len(scores.to_dataframe()) == 20


def test_the_last_row_of_a_truncated_file_is_named(tmp_path: Path) -> None:
    """A full disk can cut a file within a number, which leaves a shorter row or another number."""
    one = benchmark.problem("slide.stick")
    benchmark.export(tmp_path)
    path = write_states(tmp_path, one, one.exact(one.output_times))
    text = path.read_text()
    path.write_text(text[: text.rindex("\n5,") + 20])
    with pytest.raises(ValueError, match=r"of slide\.stick must be a number, got '' in row 502 of"):
        benchmark.score(tmp_path)


def test_an_empty_events_file_counts_as_no_events_file(tmp_path: Path) -> None:
    """Events are then inferred from the states. The file of states has both x_dot and its synonym
    vx, of which only the first is used."""
    one = benchmark.problem("slide.stick")
    rows = np.column_stack([one.output_times, one.exact(one.output_times), one.output_times])
    header = "t,x,z,theta,x_dot,z_dot,omega,vx"
    np.savetxt(tmp_path / f"{one.id}.csv", rows, "%.17g", ",", header=header, comments="")
    (tmp_path / f"{one.id}.events.csv").write_text("\n")
    (score,) = benchmark.score(tmp_path, problems=one)
    assert score.passed and score.events["times"].keys() == {"STICK"}


def test_decimal_commas_are_refused_and_empty_fields_at_the_end_are_not(tmp_path: Path) -> None:
    one = benchmark.problem("slide.stick")
    path = write_states(tmp_path, one, one.exact(one.output_times))
    head, *rows = path.read_text().splitlines()
    path.write_text("\n".join([head, *(f"{row},," for row in rows)]))
    assert benchmark.score(tmp_path, problems=one)[0].passed
    path.write_text("\n".join([head, *(row.replace(".", ",") for row in rows)]))
    with pytest.raises(ValueError, match=r"in slide\.stick\.csv line 3 must have 7 fields, got 14"):
        benchmark.score(tmp_path)


@pytest.mark.parametrize("encoding", ["utf-8-sig", "cp1252"])
def test_hidden_files_and_unknown_columns_are_ignored(encoding: str, tmp_path: Path) -> None:
    """macOS writes a hidden companion of each file. A column may have any name."""
    one = benchmark.problem("slide.stick")
    path = write_states(tmp_path, one, one.exact(one.output_times))
    path.write_text(path.read_text().replace("omega\n", "omega,Höhe\n"), encoding=encoding)
    for name in ("._slide.stick.csv", ".roll.rock.csv", ".slide.stick.events.csv"):
        (tmp_path / name).write_bytes(b"\0\5\26\7")
    assert [score.problem for score in benchmark.score(tmp_path) if score.passed] == [one.id]


def test_the_second_of_two_rows_at_one_time_is_scored(tmp_path: Path) -> None:
    """Two rows at one time are the states before and after a jump. Here the first one is wrong."""
    one = benchmark.problem("slide.stick")
    rows = np.repeat(np.column_stack([one.output_times, one.exact(one.output_times)]), 2, axis=0)
    rows[::2, 1:] += 1.0
    header = "t,x,z,theta,x_dot,z_dot,omega"
    np.savetxt(tmp_path / f"{one.id}.csv", rows, "%.17g", ",", header=header, comments="")
    (score,) = benchmark.score(tmp_path, problems=one)
    assert score.passed and score.digits > 12


def test_export_overwrites_nothing_and_follows_no_link(tmp_path: Path) -> None:
    """Nothing is written if a file, link, folder or pipe has a name to be written. Only result
    files may be present."""
    mine, place = tmp_path / "mine", tmp_path / "place"
    for name in ("README.txt", "roll.rock.json", "roll.rock.csv", "hit.settle.sdf"):
        for make in (
            lambda path: path.write_text("mine"), lambda path: path.symlink_to(mine),
            lambda path: path.symlink_to(tmp_path / "nowhere"), lambda path: path.mkdir(),
            os.mkfifo,
        ):  # fmt: skip
            place.mkdir()
            mine.write_text("mine")
            make(place / name)
            if name.endswith(".csv") and (place / name).is_file():
                benchmark.export(place)
            else:
                with pytest.raises(ValueError, match=f"folder must contain no other {name}, got"):
                    benchmark.export(place)
                assert [path.name for path in place.iterdir()] == [name]
            assert mine.read_text() == "mine" and not (tmp_path / "nowhere").exists()
            shutil.rmtree(place)


def test_a_full_disk_leaves_no_truncated_file(tmp_path: Path) -> None:
    with files_of_at_most(3000), pytest.raises(OSError, match="large"):
        benchmark.export(tmp_path)
    whole = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    written = benchmark.export(tmp_path)  # the remaining files
    assert len(whole) + len(written) == len([*tmp_path.iterdir()])
    for name, content in whole.items():
        assert (tmp_path / name).read_bytes() == content
