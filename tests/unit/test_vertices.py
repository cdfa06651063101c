"""Stores of vertices: every pixel gets room for all that it may store, and nobody else's."""

import numpy as np
import pytest

from artist_py.core.table import Table
from artist_py.transport.vertices import CHUNK, NEXT_CHUNK, SHORTAGE, Pool, has_room, rewind

THREADS = 3


def pool_of(chunks):
    return Pool(
        Table(np.zeros(chunks * CHUNK, np.int64)),
        Table(np.zeros(2, np.int64)),
        Table(np.zeros((THREADS, 3), np.int64)),
        Table(np.zeros(chunks, np.int32)),
    )


@pytest.mark.parametrize("count", [1, 100, CHUNK, CHUNK + 1, 3 * CHUNK - 1])
def test_what_threads_may_store_never_overlaps(count):
    """Threads take turns until the pool is full; each stores all that it asked for."""
    pool = pool_of(32)
    owner = np.full(32 * CHUNK, -1)
    turns = 0
    while has_room(pool, turns % THREADS, count):
        first, thread = pool.ends[turns % THREADS, 0], turns % THREADS
        assert (owner[first : first + count] == -1).all() and first + count <= len(owner)
        owner[first : first + count] = thread
        pool.ends[thread, 0] += count
        turns += 1
    assert turns >= 32 // (count // CHUNK + 1)
    assert pool.state[SHORTAGE] == 1


@pytest.mark.parametrize("count", [7, CHUNK + 1])
def test_a_failed_request_takes_nothing(count):
    pool = pool_of(1 if count > CHUNK else 0)
    before = pool.state[NEXT_CHUNK]
    assert not has_room(pool, 0, count)
    assert pool.state[NEXT_CHUNK] == before
    assert (pool.ends.array == 0).all()


def test_rewinding_goes_back_to_the_first_of_several_chunks():
    pool = pool_of(8)
    for thread in range(2):
        assert has_room(pool, thread, 2 * CHUNK)
        pool.ends[thread, 0] += 2 * CHUNK
        rewind(pool, None, thread)
        assert pool.ends[thread, 0] == 2 * thread * CHUNK
        assert has_room(pool, thread, 2 * CHUNK)
    assert pool.state[NEXT_CHUNK] == 4
