"""An index page of pictures with captions and numbers: one HTML file beside the pictures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from html import escape

_STYLE = """
body { font-family: sans-serif; max-width: 70em; margin: 2em auto; padding: 0 1em; color: #222; }
figure { margin: 0 0 3em; }
img { max-width: 100%; }
figcaption { max-width: 50em; margin: .5em 0; line-height: 1.4; }
table { border-collapse: collapse; font-size: .9em; }
td { padding: .1em 1em .1em 0; border-top: 1px solid #ddd; }
td:last-child { text-align: right; font-variant-numeric: tabular-nums; }
.failed { color: #a00; }
nav li { margin: .15em 0; }
"""


@dataclass(frozen=True)
class PageEntry:
    """One figure of the page.

    name : of its script and its picture, without ending
    title : one line
    caption, numbers : what it says; ``numbers`` by name
    failure : why there is no picture, or nothing
    """

    name: str
    title: str
    caption: str = ""
    numbers: dict[str, float] = field(default_factory=dict)
    failure: str = ""


def index_page(title: str, entries: Sequence[PageEntry]) -> str:
    """HTML that shows each figure, or names it and why it failed; its links are relative."""
    failed = [entry for entry in entries if entry.failure]
    parts = [
        f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title>',
        f"<style>{_STYLE}</style></head><body><h1>{escape(title)}</h1>",
    ]
    if failed:
        names = ", ".join(escape(entry.name) for entry in failed)
        parts.append(f'<p class="failed">{len(failed)} of {len(entries)} figures failed: {names}</p>')
    links = "".join(f'<li><a href="#{escape(e.name)}">{escape(e.title)}</a></li>' for e in entries)
    parts += [f"<nav><ul>{links}</ul></nav>", *(_figure(entry) for entry in entries), "</body></html>\n"]
    return "\n".join(parts)


def _figure(entry: PageEntry) -> str:
    name, head = escape(entry.name), f"<h2>{escape(entry.title)}</h2>"
    if entry.failure:
        return f'<figure id="{name}">{head}<pre class="failed">{escape(entry.failure)}</pre></figure>'
    rows = "".join(
        f"<tr><td>{escape(key)}</td><td>{value:.6g}</td></tr>" for key, value in entry.numbers.items()
    )
    picture = f'<a href="{name}.png"><img src="{name}.png" alt="{escape(entry.title)}" loading="lazy"></a>'
    caption = f"<figcaption>{escape(entry.caption)}</figcaption>"
    return f'<figure id="{name}">{head}{picture}{caption}<table>{rows}</table></figure>'
