"""Line tests: measurements read from files, and compared with a run."""

from catenary_fe.results.line_test.compare import compare_with_line_test
from catenary_fe.results.line_test.comparison import LineTestComparison, PlacedPass
from catenary_fe.results.line_test.files import is_measurement
from catenary_fe.results.line_test.reading import read_line_test
from catenary_fe.results.line_test.record import LineTest, MeasuredPass
from catenary_fe.results.line_test.signals import Place

__all__ = [
    "LineTest", "LineTestComparison", "MeasuredPass", "Place", "PlacedPass", "compare_with_line_test",
    "is_measurement", "read_line_test",
]  # fmt: skip
