"""Dropper lengths by hand: strings under point loads, with nothing of the program but the line's data."""

import numpy as np

import catenary_fe as cf

GRAVITY = 9.81


def dropper_lengths(line: cf.Catenary, span: int) -> np.ndarray:
    """[m], shape (droppers,), of an inner span between equal ones; no stitch wires, in the plane."""
    one = line.spans[span - 1]
    wire, messenger = line.contact_wire, line.messenger_wire
    x = np.array([d.position for d in one.droppers])
    z = -4 * one.pre_sag * (x - x[0]) * (x[-1] - x) / (x[-1] - x[0]) ** 2
    pull = np.zeros(x.size)
    wires = len(line.contact_wire_offsets)
    first = int(np.flatnonzero(line.dropper_spans == span)[0])
    for k in range(wires):  # each contact wire hangs on its own droppers and is held at the supports
        i = np.flatnonzero((first + np.arange(x.size)) % wires == k)
        xs, zs = np.r_[0, x[i], one.length], np.r_[0, z[i], 0]
        weight = wire.mass_per_length * GRAVITY * (xs[2:] - xs[:-2]) / 2
        pull[i] = weight - wire.tension * np.diff(np.diff(zs) / np.diff(xs))
    length = np.ones(x.size)
    of_dropper = np.array([d.mass_per_length for d in one.droppers])
    clamps = np.array([d.messenger_clamp_mass + d.contact_wire_clamp_mass for d in one.droppers])
    stiffness = np.array([d.stiffness for d in one.droppers])
    w = messenger.mass_per_length * GRAVITY
    for _ in range(30):
        load = pull + (of_dropper * length + clamps) * GRAVITY
        end = w * one.length / 2 + np.sum(load * (one.length - x)) / one.length
        moment = np.array([end * v - w * v**2 / 2 - np.sum(load[x < v] * (v - x[x < v])) for v in x])
        half = GRAVITY * (
            of_dropper * length / 2 + np.array([d.contact_wire_clamp_mass for d in one.droppers])
        )
        length = line.system_height - moment / messenger.tension - z - (pull + half) / stiffness
    return length
