"""Outlines of polygons as result.h5 has them: all vertices in one array, and where the rings of each block begin in it."""

from __future__ import annotations

from functools import cached_property

import numpy as np


class Rings:
    """Which vertices make up which ring of which block; nv vertices, nb blocks.

    Entries [block_rings[b], block_rings[b + 1]) of `start` belong to block b: where each of its rings begins, and where the last one ends.
    """

    def __init__(self, start: np.ndarray, block_rings: np.ndarray, vertices: int) -> None:
        """Throws ValueError where the arrays do not fit each other."""
        self.start = start.astype(np.int64)
        self.block_rings = block_rings.astype(np.int64)
        self.blocks = len(block_rings) - 1
        self.vertices = vertices
        limits, begins = self.block_rings, self.start
        fits = (
            self.blocks >= 0
            and (self.blocks == 0 or (limits[0] == 0 and limits[-1] == len(begins) and bool((np.diff(limits) >= 2).all())))
            and (begins.size == 0 or bool(begins.min() >= 0 and begins.max() <= vertices))
            and bool((np.diff(self.ranges, axis=1) >= 3).all())
        )
        if not fits:
            raise ValueError("ring_start does not give rings of vertices")

    @cached_property
    def ranges(self) -> np.ndarray:
        """First vertex of each ring and the one after its last, (rings, 2)."""
        is_ring = np.ones(len(self.start), dtype=bool)
        is_ring[self.block_rings[1:] - 1] = False  # the last entry of each block ends its last ring
        begins = np.flatnonzero(is_ring)
        return np.column_stack([self.start[begins], self.start[begins + 1]])

    @cached_property
    def ring_block(self) -> np.ndarray:
        """Block of each ring, (rings,)."""
        return np.repeat(np.arange(self.blocks), np.diff(self.block_rings) - 1)

    @cached_property
    def next_vertex(self) -> np.ndarray:
        """The vertex after each in its ring, (nv,)."""
        following = np.arange(1, self.vertices + 1)
        following[self.ranges[:, 1] - 1] = self.ranges[:, 0]
        return following

    @cached_property
    def vertex_block(self) -> np.ndarray:
        """Block of each vertex, (nv,)."""
        owner = np.zeros(self.vertices, dtype=np.int64)
        for (begin, end), block in zip(self.ranges, self.ring_block):
            owner[begin:end] = block
        return owner

    def of(self, block: int, at: np.ndarray) -> list[np.ndarray]:
        """Outlines of a block whose vertices are `at`, (nv, 2): the outer ring, then holes, each (n, 2)."""
        limits = self.start[self.block_rings[block] : self.block_rings[block + 1]]
        return [at[i:j] for i, j in zip(limits[:-1], limits[1:])]

    def centroids(self, at: np.ndarray) -> np.ndarray:
        """Centroids of all blocks whose vertices are `at`, (nv, 2) → (nb, 2). Local coordinates keep the digits."""
        if self.blocks == 0:
            return np.zeros((0, 2))
        base = at[self.ranges[np.searchsorted(self.ring_block, np.arange(self.blocks)), 0]]
        p = at - base[self.vertex_block]
        q = p[self.next_vertex]
        twice = p[:, 0] * q[:, 1] - q[:, 0] * p[:, 1]
        sums = [np.bincount(self.vertex_block, w, self.blocks) for w in (twice, *((p + q) * twice[:, None]).T)]
        with np.errstate(invalid="ignore", divide="ignore"):
            return base + np.column_stack(sums[1:]) / (3.0 * sums[0][:, None])
