"""Marks for a table of answers, and messages for lines that cannot be read."""

from io import BytesIO, StringIO
from pathlib import Path

import pytest
from course.by_hand import answer
from rolling_ellipse import course

HEAD = "student,seed,task,answer"


def table(*rows: str, head: str = HEAD) -> StringIO:
    return StringIO("\n".join((head, *rows)))


def test_a_table_of_answers_is_marked_line_by_line() -> None:
    """Answers are right or have one or two known mistakes. Lines that cannot be read are listed by
    number, and all others are marked. The last answer to a task counts."""
    right, wrong = answer("3.2", (), 7), answer("3.2", ("sign", "inertia"), 8)
    marked = course.mark_table(
        table(
            f"Ada,7,3.2,{1.5 * right}", f"Ada,7,3.2,{right}", f"Ada,7,1.1,{-answer('1.1', (), 7)}",
            f"Bob,8,3.2,{wrong}", "Bob,8,3.1,twenty", "Bob,9,3.1,20", "Bob,8,3.9,20", "Bob,8,3.1,",
            "Cid,seven,3.1,20", f"Dan,,3.2,{answer('3.2')}", "Eve,8,3.1,nan", "Eve,-8,3.1,1",
            "Eve,8,3.1", f"Eve,{2**53 + 1},3.1,1", "Eve,8,3.1,1e999",
        )
    )  # fmt: skip
    assert marked.points == {"Ada": 3, "Bob": 0, "Cid": 0, "Dan": 2, "Eve": 0}
    assert marked.mistakes == {"none": 2, "sign": 1, "sign and inertia": 1}
    assert marked.marks["Ada"]["3.2"] == course.mark("3.2", right, seed=7)
    assert [*marked.refused] == [6, 7, 8, 9, 10, 12, 13, 14, 15, 16]
    words = [message.split()[0] for message in marked.refused.values()]
    assert words == ["answer", "seed", "task", "answer", "seed", "answer", "seed", "answer",
                     "seed", "answer"]  # fmt: skip
    assert "'twenty'" in marked.refused[6] and "8, as in earlier lines" in marked.refused[7]


def test_lines_with_too_many_fields_or_without_a_name_are_refused() -> None:
    """A decimal comma without quotes gives a field too many. Empty fields at the end do not."""
    right = answer("3.1", (), 7)
    rows = (
        "A,7,3.1,19,16",
        ",7,3.1,19",
        "  ,7,3.1,19",
        f"A,7,3.1,{right},,",
        "A,,3.1,19",
        "B,,3.1,1",
    )
    marked = course.mark_table(table(*rows, "B,7,3.1,1"))
    assert marked.points == {"A": 2, "B": 0}
    assert marked.refused == {
        2: "line 2 must have 4 fields, got 5; a decimal comma needs quotes or another delimiter",
        3: "student must be a name, got none",
        4: "student must be a name, got none",
        6: "seed must be 7, as in earlier lines, got none",
        8: "seed must be none, as in earlier lines, got 7",
    }


@pytest.mark.parametrize("mark", [",", ";", "\t"])
def test_tables_of_spreadsheets_are_read(mark: str, tmp_path: Path) -> None:
    """Spreadsheets write other separators, decimal commas, U+2212 signs and byte order marks."""
    text = f"{answer('3.2', (), 7):.4f}".replace("-", "−").replace(".", ",")
    rows = ["Answer", "note", " Task", "seed", "student"], [f'"{text}"', "x", "3.2", "7", '"A, B"']
    content = "\r\n".join(mark.join(row) for row in rows).encode("utf-8-sig")
    (tmp_path / "answers.csv").write_bytes(content)
    for given in (tmp_path / "answers.csv", str(tmp_path / "answers.csv"), BytesIO(content)):
        assert course.mark_table(given).points == {"A, B": 2}


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "cp1252"])
def test_students_with_accents_stay_apart(encoding: str, tmp_path: Path) -> None:
    """Spreadsheets write cp1252, where two letters must not become the same placeholder."""
    right = answer("1.1", (), 7)
    text = f"{HEAD}\nJörg,7,1.1,{right}\nJürg,7,1.1,9\n"
    (tmp_path / "answers.csv").write_text(text, encoding=encoding)
    marks = {"Jörg": 2, "Jürg": 0}
    assert course.mark_table(tmp_path / "answers.csv").points == marks
    assert course.mark_table(BytesIO(text.encode(encoding))).points == marks
    assert course.mark_table(StringIO("\ufeff" + text)).points == marks


@pytest.mark.parametrize(
    ("line", "why"),
    [
        ('"Bob,7,1.1,1', "line 3 must have quotes in pairs and short fields, got ',' expected"),
        ('Bob,"7"8,1.1,1', "line 3 must have quotes in pairs and short fields, got ',' expected"),
        ("B" * 140_000 + ",7,1.1,1", "line 3 must have quotes in pairs and short fields, got fie"),
        (f"Bob,{'7' * 5000},1.1,1", "seed must be a whole number, got '777"),
        (f"Bob,{'7' * 640},1.1,1", "seed must be a whole number from 0 to 2^53, got 777"),
        ("Bob,1_0,1.1,1", "seed must be a whole number, got '1_0'"),
        ("Bob,7,1.1,1_0", "answer must be a number, got '1_0'"),
    ],
)
def test_a_line_that_is_malformed_costs_no_other_line(line: str, why: str) -> None:
    """A quoted field may have several lines; a line is counted where it begins."""
    right = answer("1.1", (), 7)
    rows = [f"Ada,7,1.1,{right}", line, f"Cid,7,1.1,{right},", f'"D\n",7,1.1,{right}', "E,7,1.1,x"]
    marked = course.mark_table(table(*rows))
    assert {name: n for name, n in marked.points.items() if n} == {"Ada": 2, "Cid": 2, "D": 2}
    assert [*marked.refused] == [3, 7] and marked.refused[3].startswith(why)


def test_a_quote_without_a_partner_costs_no_other_line() -> None:
    marked = course.mark_table(table('"Bob,8,1.1,0.2', "Cy,9,1.1,0.2", "Di,10,1.1,0.3"))
    said = "line 2 must have quotes in pairs and short fields, got unexpected end of data"
    assert [*marked.points] == ["Cy", "Di"] and marked.refused == {2: said}


@pytest.mark.parametrize("name", HEAD.split(","))
def test_a_column_that_occurs_twice_is_named(name: str) -> None:
    with pytest.raises(ValueError, match=f"table must have the column {name}, got 2 in"):
        course.mark_table(table("Ada,7,1.1,0.2,0.9", head=f"{HEAD},{name.title()}"))


@pytest.mark.parametrize("missing", HEAD.split(","))
def test_a_missing_column_is_named(missing: str) -> None:
    head = ",".join(name for name in HEAD.split(",") if name != missing)
    with pytest.raises(ValueError, match=f"table must have the column {missing}, got"):
        course.mark_table(table("a,b,c", head=head))
