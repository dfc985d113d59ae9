"""A controller that pushes the frame by the contact force: EN 50318:2002 at 300 km/h, for several gains.

Run it with ``python models/studies/active_pantograph.py``; it takes minutes, prints a table and draws
``active_pantograph.png`` beside itself. The controller is invented: it sees the contact force below 20 Hz,
every 5 ms, and its actuator follows within 10 ms and by at most 80 N.
"""

from __future__ import annotations

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import catenary_fe as cf

LAYOUT = Path(__file__).parents[1] / "layouts" / "en50318_2002.toml"
SPEED, UPLIFT, TARGET = 300 / 3.6, 120.0, 115.0  # m/s, N, N
SAMPLE, LAG, LIMIT = 5e-3, 10e-3, 80.0  # s, s, N
SEEN = 20.0  # Hz
GAINS = (0.0, 0.25, 0.5, 1.0, 2.0)  # N/N


def steered(shape: cf.Shape, gain: float, *, ideal: bool = False) -> cf.Run:
    """A run with a controller of this gain; an ideal one knows the force and pushes as it likes, at once."""
    head = cf.library.pantograph("EN 50318:2002")
    session = cf.stepping(shape, [head], speed=SPEED, positions=[10.0])
    seen, push, step = float(session.contact_force[0]), 0.0, 1e-3
    every = 1 if ideal else round(SAMPLE / step)
    asked, n = 0.0, 0
    while not session.finished:
        force = float(session.contact_force[0])
        seen = force if ideal else seen + (1 - np.exp(-2 * np.pi * SEEN * step)) * (force - seen)
        if n % every == 0:
            asked = gain * (TARGET - seen)
        push = asked if ideal else push + step / LAG * (float(np.clip(asked, -LIMIT, LIMIT)) - push)
        session.step(uplift_force=UPLIFT + push)
        n += 1
    return session.run()


def main() -> None:
    """Compare."""
    shape = cf.find_form(cf.load_catenary(LAYOUT))
    axes = plt.figure(figsize=(6, 3.2), layout="constrained").subplots()
    for name, ideal in (("sampled sensor, actuator with a lag", False), ("ideal sensor and actuator", True)):
        sigma = []
        for gain in GAINS:
            force = steered(shape, gain, ideal=ideal).contact_force_statistics()[0]
            sigma.append(force.std)
            print(f"{name:35s} gain {gain:5.2f}: mean {force.mean:6.1f} N, σ {force.std:5.2f} N", flush=True)
        axes.plot(GAINS, sigma, "o-", label=name)
    axes.set(xlabel="gain [N/N]", ylabel="σ of the contact force [N]", ylim=(0, 40))
    axes.set_title("EN 50318:2002 at 300 km/h, an invented controller", fontsize="medium")
    axes.legend(loc="lower left")
    axes.get_figure().savefig(Path(__file__).with_suffix(".png"), dpi=120)  # type: ignore[union-attr]


if __name__ == "__main__":
    main()
