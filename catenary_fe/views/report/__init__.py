"""A run's report, and several runs side by side: one HTML page that needs neither files nor a network."""

from catenary_fe.views.report.conform import conformity_page
from catenary_fe.views.report.page import comparison_page, line_test_page, report_page
from catenary_fe.views.report.sweep import sweep_page

__all__ = ["comparison_page", "conformity_page", "line_test_page", "report_page", "sweep_page"]
