"""What moves in a run, frame by frame, and a film of it as GIF or MP4."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from numpy.typing import NDArray

from catenary_fe.layout import InputError
from catenary_fe.layout.arguments import checked, number, span_numbers, whole
from catenary_fe.results import Run, WireHistory
from catenary_fe.results.files import atomic_write
from catenary_fe.results.wires import contact_wires
from catenary_fe.views import style

Floats = NDArray[np.float64]
_SIZE, _DPI = (10.0, 5.4), 96  # [in], dots per inch: even numbers of pixels, which MP4 needs
MASS_GAP = 0.3  # [m] drawn between a pantograph's masses
_BASE = 0.3  # [m] of room below the lowest and above the highest thing drawn


@dataclass(frozen=True)
class Scene:
    """Wires, droppers and pantographs at the times of the frames.

    time : [s], shape (frames,)
    wires : with their shapes at these times; contact wires first
    dropper_x : [m], shape (droppers,)
    dropper_ends : numbers in ``wires`` of each dropper's lower and upper wire, shape (droppers, 2)
    dropper_slack : shape (frames, droppers)
    support_x : [m], shape (supports,)
    pantograph_x : [m], shape (pantographs, frames)
    rest : [m], shape (pantographs, frames), static height of the contact wire at each pantograph
    masses : for each pantograph [m] shape (masses, frames), motion above ``rest`` since the run's start
    force : [N], shape (pantographs, frames), low-passed at 20 Hz
    """

    time: Floats
    wires: tuple[WireHistory, ...]
    dropper_x: Floats
    dropper_ends: NDArray[np.int64]
    dropper_slack: NDArray[np.bool_]
    support_x: Floats
    pantograph_x: Floats
    rest: Floats
    masses: tuple[Floats, ...]
    force: Floats

    def heights(self, wire: int, frame: int, magnified: float = 1.0) -> Floats:
        """[m], shape (points,), of a wire, its motion magnified about the static shape."""
        history = self.wires[wire]
        heights: Floats = history.static + magnified * history.uplift[frame]
        return heights

    def head_height(self, pantograph: int, frame: int, heights: Sequence[Floats]) -> float:
        """[m] of the contact wire that a head is under, the lowest of those that are there.

        heights : as drawn, of each wire
        """
        x = self.pantograph_x[pantograph, frame]
        there = [i for i, w in enumerate(self.wires) if w.touched and w.x[0] <= x <= w.x[-1]]
        true = {i: float(np.interp(x, self.wires[i].x, self.heights(i, frame))) for i in there}
        lowest = min(true, key=true.__getitem__)
        return float(np.interp(x, self.wires[lowest].x, heights[lowest]))

    def mass_heights(self, pantograph: int, magnified: float = 1.0) -> Floats:
        """[m], shape (masses, frames), that masses are drawn at: below the wire at rest, motion magnified."""
        motion = self.masses[pantograph]
        below = MASS_GAP * np.arange(len(motion))[:, None]
        heights: Floats = self.rest[pantograph] - below + magnified * motion
        return heights

    def extent(self, start: float, end: float, magnified: float = 1.0) -> tuple[float, float]:
        """[m] lowest and highest of what is drawn between two positions [m] along the line, in all frames."""
        heights = []
        for wire in self.wires:
            shown = (wire.x >= start) & (wire.x <= end)
            heights.append((wire.static + magnified * wire.uplift)[:, shown].ravel())
        for i, x in enumerate(self.pantograph_x):
            seen = (x >= start) & (x <= end)
            heights += [self.rest[i, seen], self.mass_heights(i, magnified)[:, seen].ravel()]
        drawn = np.concatenate(heights)
        return float(np.nanmin(drawn)), float(np.nanmax(drawn))


def scene(run: Run, frames: Sequence[int] | NDArray[np.int64] | None = None) -> Scene:
    """The scene of a run at some of its stored wire shapes (numbers from 0); unset: at all of them.

    Raises InputError where the run stored no wire shapes.
    """
    wires = run.wires()
    chosen = np.arange(wires[0].time.size) if frames is None else np.asarray(frames)
    at = np.searchsorted(run.time, wires[0].time[chosen] - 0.5 * run.step)
    data = run.data
    dropper_x = np.asarray(data["dropper_position"].values)
    hung = run.catenary.dropper_contact_wires
    positions, masses = np.asarray(data["position"].values), data["mass_height"].values
    rest = np.fmin.reduce(
        [np.interp(positions, w.x, w.static, left=np.nan, right=np.nan) for w in contact_wires(wires)]
    )
    moved = (masses - masses[:, :, :1] - (rest - rest[:, :1])[:, None, :])[:, :, at]
    return Scene(
        time=wires[0].time[chosen],
        wires=tuple(
            WireHistory(wire.name, wire.x, wire.static, wire.height[chosen], wire.time[chosen])
            for wire in wires
        ),
        dropper_x=dropper_x,
        dropper_ends=np.array(
            [_ends(wires, x, int(n)) for x, n in zip(dropper_x, hung, strict=True)], dtype=np.int64
        ).reshape(-1, 2),
        dropper_slack=np.asarray(data["dropper_force"].values[:, at] <= 0).T,
        support_x=np.asarray(data["support_position"].values),
        pantograph_x=positions[:, at],
        rest=rest[:, at],
        masses=tuple(m[np.isfinite(m[:, 0])] for m in moved),
        force=run.filtered_contact_force()[:, at],
    )


def _ends(wires: Sequence[WireHistory], x: float, number: int) -> tuple[int, int]:
    """The contact wire (of this number, from 0) at a dropper, and the lowest other wire above it there."""
    heights = [float(np.interp(x, w.x, w.static, left=np.nan, right=np.nan)) for w in wires]
    lower = [i for i, wire in enumerate(wires) if wire.touched][number]
    own = wires[lower].section
    above = [
        i
        for i, wire in enumerate(wires)
        if not wire.touched and wire.section == own and np.isfinite(heights[i])
    ]
    return lower, min(above, key=lambda i: heights[i], default=lower)


@checked
@style.styled
def film(
    run: Run,
    path: str | Path,
    *,
    spans: Sequence[int] | None = None,
    slowed: float = 4.0,
    frames_per_second: int = 20,
    magnified: float = 5.0,
    progress: Callable[[float], None] | None = None,
) -> Path:
    """Draw pantographs that pass some spans; the format is the file's ending, .gif or .mp4.

    spans : numbers of the spans, from 1; unset: the evaluated ones
    slowed : how many times slower than real time
    frames_per_second : at most 50, the most that GIF players keep
    magnified : how many times the motion about the static shape is drawn larger than the heights

    Raises InputError where the run stored no wire shapes, for values out of range, or a path that cannot be
    written.
    """
    path = Path(path)
    if path.suffix.lower() not in (".gif", ".mp4"):
        raise InputError(f"{path}: a film's name ends with .gif or .mp4")
    for name, value in (("slowed", slowed), ("magnified", magnified)):
        number(f"film: {name}", value, above=0.0)
    whole("film: frames_per_second", frames_per_second, least=1, most=50)
    view = _View(run, spans, magnified, slowed)
    stored = run.wires()[0].time
    wanted = np.arange(view.begin, view.stop, 1 / (frames_per_second * slowed))
    frames = np.clip(np.round((wanted - stored[0]) / (stored[1] - stored[0])), 0, stored.size - 1)
    pictures = view.pictures(scene(run, frames.astype(np.int64)), progress)
    write = _write_gif if path.suffix.lower() == ".gif" else _write_mp4
    with atomic_write(path) as aside:
        write(aside, pictures, frames_per_second)
    return path


class _View:
    """The window of the film: what stands still is drawn once, what moves in each frame."""

    def __init__(self, run: Run, spans: Sequence[int] | None, magnified: float, slowed: float) -> None:
        spans = span_numbers(spans, run.data.sizes["support"] - 1, run.evaluated_spans)
        supports = run.data["support_position"].values
        room = supports[max(spans)] - supports[min(spans) - 1]
        self.start = max(0.0, float(supports[min(spans) - 1] - 0.15 * room))
        self.end = min(float(supports[-1]), float(supports[max(spans)] + 0.15 * room))
        positions = run.data["position"].values
        seen = ((positions >= self.start) & (positions <= self.end)).any(axis=0)
        if not seen.any():
            raise InputError(f"no pantograph was ever inside spans {list(spans)}")
        self.begin, self.stop = float(run.time[seen][0]), float(run.time[seen][-1])
        self.magnified, self._run = magnified, run
        self.figure = style.Picture(figsize=_SIZE, dpi=_DPI, layout="constrained")
        self._canvas: Any = FigureCanvasAgg(self.figure)
        self._wires: Axes
        self._wires, self._force = self.figure.subplots(2, 1, height_ratios=(3, 2), sharex=True)
        self._title = style.run_title(run, f", {slowed:g} times slower")

    def pictures(self, scene: Scene, progress: Callable[[float], None] | None) -> Iterator[NDArray[np.uint8]]:
        """Shape (height, width, 3), frame by frame."""
        moving = self._draw(scene)
        self._canvas.draw()
        background = self._canvas.copy_from_bbox(self.figure.bbox)
        for frame in range(scene.time.size):
            self._canvas.restore_region(background)
            self._move(moving, scene, frame)
            for artist in moving["all"]:
                artist.axes.draw_artist(artist)
            yield np.asarray(self._canvas.buffer_rgba())[..., :3].copy()
            if progress:
                progress((frame + 1) / scene.time.size)

    def _draw(self, scene: Scene) -> dict[str, Any]:
        """Axes and everything that stands still; returns what moves."""
        ax, supports = self._wires, scene.support_x
        low, high = scene.extent(self.start, self.end, self.magnified)
        low, high = low - _BASE, high + 0.12 * (high - low) + _BASE
        style.mark_supports(ax, supports, label=False)
        style.mark_supports(self._force, supports, label=False)
        ax.set_xlim(self.start, self.end)
        ax.set_ylim(low, high)
        width, height = _SIZE[0] * 0.9 / (self.end - self.start), _SIZE[1] * 0.5 / (high - low)
        style.note_failed(style.finish(ax, "", "height above rail (m)", self._title), self._run.failed_checks)
        note = f"heights about {height / width:.0f}, motion another {self.magnified:g} times exaggerated"
        ax.text(0.995, 1.02, note, transform=ax.transAxes, ha="right", fontsize=8, color=style.SUPPORT)
        self._draw_force()
        options: dict[str, Any] = {"animated": True}
        colours = [style.wire_colour(wire.name) for wire in scene.wires]
        wires = [ax.plot([], [], color=colour, linewidth=1.5, **options)[0] for colour in colours]
        for kind in style.WIRES:
            if style.wire_colour(kind) in colours:
                ax.plot([], [], color=style.wire_colour(kind), linewidth=1.5, label=kind)
        taut = ax.plot([], [], color=style.DROPPER, linewidth=0.9, **options)[0]
        slack = ax.plot([], [], color=style.SLACK, linewidth=1.8, linestyle=":", **options)[0]
        ax.plot([], [], color=style.SLACK, linewidth=1.8, linestyle=":", label="slack dropper")
        ax.legend(loc="upper left", fontsize=8, frameon=False, ncols=4)
        clock = ax.text(0.995, 0.93, "", transform=ax.transAxes, ha="right", fontsize=9, **options)
        of_each = [style.pantograph_colour(i) for i in range(len(scene.masses))]
        heads = [ax.plot([], [], "s-", color=c, markersize=7, **options)[0] for c in of_each]
        points = [self._force.plot([], [], "o", color=c, markersize=7, **options)[0] for c in of_each]
        everything = [taut, slack, *wires, *heads, *points, clock]
        return {"wires": wires, "taut": taut, "slack": slack, "heads": heads, "points": points,
                "clock": clock, "all": everything}  # fmt: skip

    def _draw_force(self) -> None:
        run, ax = self._run, self._force
        names, positions = run.data["pantograph"].values, run.data["position"].values
        top = 0.0
        for i, force in enumerate(run.filtered_contact_force()):
            inside = (positions[i] >= self.start) & (positions[i] <= self.end)
            colour = style.pantograph_colour(i)
            ax.plot(positions[i][inside], force[inside], color=colour, linewidth=1.0, label=str(names[i]))
            top = max(top, float(force[inside].max(initial=0.0)))
        ax.set_ylim(0, 1.25 * top or 1.0)
        ax.legend(loc="upper left", fontsize=8, frameon=False, ncols=2)
        style.finish(ax, style.ALONG, "contact force\n0 to 20 Hz (N)", "")

    def _move(self, moving: dict[str, Any], scene: Scene, frame: int) -> None:
        heights = [scene.heights(i, frame, self.magnified) for i in range(len(scene.wires))]
        for line, wire, z in zip(moving["wires"], scene.wires, heights, strict=True):
            line.set_data(wire.x, z)
        self._move_droppers(moving, scene, frame, heights)
        for i, (head, point) in enumerate(zip(moving["heads"], moving["points"], strict=True)):
            x = scene.pantograph_x[i, frame]
            top = scene.head_height(i, frame, heights) - 0.06
            below = scene.mass_heights(i, self.magnified)[1:, frame] - 0.06
            head.set_data([x] * (below.size + 2), [top, *below, self._wires.get_ylim()[0]])
            point.set_data([x], [scene.force[i, frame]])
        moving["clock"].set_text(f"t = {scene.time[frame]:.2f} s")

    def _move_droppers(self, moving: dict[str, Any], scene: Scene, frame: int, heights: list[Floats]) -> None:
        ends = np.array(
            [
                [np.interp(x, scene.wires[w].x, heights[w]) for w in pair]
                for x, pair in zip(scene.dropper_x, scene.dropper_ends, strict=True)
            ]
        ).reshape(-1, 2)
        slack = scene.dropper_slack[frame]
        for name, chosen in (("taut", ~slack), ("slack", slack)):
            x, z = scene.dropper_x[chosen], ends[chosen]
            gap = np.full(x.size, np.nan)
            moving[name].set_data(
                np.column_stack([x, x, gap]).ravel(), np.column_stack([z[:, 0], z[:, 1], gap]).ravel()
            )


def _write_gif(path: Path, pictures: Iterator[NDArray[np.uint8]], rate: int) -> None:
    from PIL import Image

    first = Image.fromarray(next(pictures))
    palette = first.quantize(64)
    rest = (Image.fromarray(p).quantize(palette=palette, dither=Image.Dither.NONE) for p in pictures)
    palette.save(path, save_all=True, append_images=rest, duration=1000 / rate, loop=0, optimize=False)


def _write_mp4(path: Path, pictures: Iterator[NDArray[np.uint8]], rate: int) -> None:
    try:
        from imageio_ffmpeg import count_frames_and_secs, write_frames
    except ImportError:
        raise InputError(
            'an MP4 film needs the package imageio-ffmpeg: pip install "catenary_fe[film]"; or name a .gif'
        ) from None
    path.touch()  # the encoder's own report of a path that cannot be written is a page long
    first = next(pictures)
    height, width, _ = first.shape
    writer = write_frames(
        str(path), (width, height), fps=rate, quality=7, macro_block_size=2, ffmpeg_log_level="quiet"
    )
    writer.send(None)
    sent = 0
    for picture in itertools.chain([first], pictures):
        writer.send(np.ascontiguousarray(picture))
        sent += 1
    writer.close()
    try:
        written, _ = count_frames_and_secs(str(path))
    except RuntimeError:
        written = 0
    if written != sent:  # the encoder itself does not say so
        raise OSError(f"{written} of {sent} pictures arrived; the disk may be full")
