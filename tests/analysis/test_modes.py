"""Modes: against an independent formulation, against strings, their kinds; modal runs against full ones."""

import numpy as np
import pytest
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import eigsh

import catenary_fe as cf


def tensioned_beam(length, inclination, *, mass, axial, bending, tension):
    """K and M of a straight element, (along, up, turn) at both ends: bar, beam and string in one."""
    L, EI, N = length, bending, tension / np.cos(inclination)
    K, M = np.zeros((6, 6)), np.zeros((6, 6))
    up, bar = np.ix_([1, 2, 4, 5], [1, 2, 4, 5]), np.ix_([0, 3], [0, 3])
    flexure = np.array([
        [12, 6 * L, -12, 6 * L], [6 * L, 4 * L**2, -6 * L, 2 * L**2],
        [-12, -6 * L, 12, -6 * L], [6 * L, 2 * L**2, -6 * L, 4 * L**2],
    ])  # fmt: skip
    string = np.array([
        [36, 3 * L, -36, 3 * L], [3 * L, 4 * L**2, -3 * L, -(L**2)],
        [-36, -3 * L, 36, -3 * L], [3 * L, -(L**2), -3 * L, 4 * L**2],
    ])  # fmt: skip
    inertia = np.array([
        [156, 22 * L, 54, -13 * L], [22 * L, 4 * L**2, 13 * L, -3 * L**2],
        [54, 13 * L, 156, -22 * L], [-13 * L, -3 * L**2, -22 * L, 4 * L**2],
    ])  # fmt: skip
    K[up] = EI / L**3 * flexure + N / (30 * L) * string
    K[bar] = axial / L * np.array([[1, -1], [-1, 1]])
    M[up] = mass * L / 420 * inertia
    M[bar] = mass * L / 6 * np.array([[2, 1], [1, 2]])
    c, s = np.cos(inclination), np.sin(inclination)
    turn = np.kron(np.eye(2), np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]))
    return turn.T @ K @ turn, turn.T @ M @ turn


class Frame:
    """Tensioned beams and springs, put together from nothing but the layout and the static shape."""

    def __init__(self):
        self.K, self.M, self.size = [], [], 0

    def add(self, where, index, block):
        where.extend((i, j, block[a, b]) for a, i in enumerate(index) for b, j in enumerate(index))

    def wire(self, wire, x, z):
        first = self.size
        self.size += 3 * x.size
        for i in range(x.size - 1):
            dx, dz = x[i + 1] - x[i], z[i + 1] - z[i]
            K, M = tensioned_beam(
                np.hypot(dx, dz), np.arctan2(dz, dx), mass=wire.mass_per_length, tension=wire.tension,
                axial=wire.axial_stiffness, bending=wire.bending_stiffness,
            )  # fmt: skip
            index = range(first + 3 * i, first + 3 * i + 6)
            self.add(self.K, index, K)
            self.add(self.M, index, M)
        return first

    def frequencies(self, held, count):
        K, M = (coo_matrix((v, (i, j)), (self.size,) * 2).tocsc() for i, j, v in map(zip_, (self.K, self.M)))
        free = np.setdiff1d(np.arange(self.size), held)
        squares = eigsh(K[free][:, free], count, M[free][:, free], sigma=0, return_eigenvectors=False)
        return np.sqrt(np.sort(squares)) / (2 * np.pi)


def zip_(triplets):
    return (np.array(column) for column in zip(*triplets, strict=True))


def independent_frequencies(shape, count, element=0.5):
    """First frequencies [Hz] by :class:`Frame`, on a mesh of its own."""
    line = shape.catenary
    supports, droppers = line.support_positions, line.dropper_positions
    x = np.unique(np.round(np.concatenate([np.arange(0, line.length, element), supports, droppers]), 9))
    frame, origins, heights = Frame(), [], []
    for wire, nodes, z in (
        (line.contact_wire, shape.contact_wire_x, shape.contact_wire_z),
        (line.messenger_wire, shape.messenger_wire_x, shape.messenger_wire_z),
    ):
        # the static shape's own nodes are fine enough for a parabola through them
        heights.append(np.interp(x, nodes, z))
        origins.append(frame.wire(wire, x, heights[-1]))
    (contact, messenger), at = origins, 3 * np.searchsorted(x, np.round(droppers, 9))
    for i, dropper in enumerate(line.droppers):
        lower, upper = contact + at[i], messenger + at[i]
        length = heights[1][at[i] // 3] - heights[0][at[i] // 3]
        pull = np.diag([shape.dropper_forces[i] / length, dropper.stiffness])
        frame.add(frame.K, [lower, lower + 1, upper, upper + 1], np.block([[pull, -pull], [-pull, pull]]))
        half = dropper.mass_per_length * length / 2 * np.eye(2)
        frame.add(frame.M, [lower, lower + 1], half + dropper.contact_wire_clamp_mass * np.eye(2))
        frame.add(frame.M, [upper, upper + 1], half + dropper.messenger_clamp_mass * np.eye(2))
    at = 3 * np.searchsorted(x, np.round(supports, 9))
    held = [contact, messenger, *(o + at[e] + 1 for o in origins for e in (0, -1))]
    for i, support in list(enumerate(line.supports))[1:-1]:
        if support.messenger_stiffness is None:
            held.append(messenger + at[i] + 1)
        else:
            frame.add(frame.K, [messenger + at[i] + 1], np.array([[support.messenger_stiffness]]))
        if arm := support.steady_arm:
            frame.add(frame.K, [contact + at[i] + 1], np.array([[arm.stiffness]]))
            frame.add(frame.M, [contact + at[i], contact + at[i] + 1], arm.mass * np.eye(2))
    return frame.frequencies(held, count)
