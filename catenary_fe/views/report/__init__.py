"""A run's report: one HTML page that needs nothing else, neither files nor a network."""

from catenary_fe.views.report.page import report_page

__all__ = ["report_page"]
