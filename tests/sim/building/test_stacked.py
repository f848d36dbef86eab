"""Rows are stacked again only where any of the arrays is another one."""

import numpy as np

from mend.sim.building.stacked import StackedRows

A, B = np.arange(8.0).reshape(2, 4), np.ones((1, 4))


def test_all_rows_are_in_it_in_their_order() -> None:
    assert StackedRows().of("F1", (A, B)).tolist() == [*A.tolist(), *B.tolist()]
    assert StackedRows().of("F1", ()).shape == (0, 4)


def test_it_is_the_same_one_as_long_as_they_are() -> None:
    rows = StackedRows()
    first, elsewhere = rows.of("F1", (A, B)), rows.of("F2", (B,))
    assert rows.of("F1", (A, B)) is first
    assert rows.of("F2", (B,)) is elsewhere


def test_it_is_made_anew_where_one_is_another_or_there_are_more_or_fewer() -> None:
    rows = StackedRows()
    rows.of("F1", (A, B))
    assert rows.of("F1", (A, B + 1.0)).tolist()[-1] == [2.0] * 4
    assert len(rows.of("F1", (A, B, B))) == 4
    assert len(rows.of("F1", (A,))) == 2
