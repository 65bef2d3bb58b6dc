"""What rides on the frame, and what becomes of the vehicle when it is let go."""

from __future__ import annotations

import numpy as np
import pytest
from flights import ENGINES
from hooked import (
    CARGO,
    CARGO_INERTIA,
    G,
    assert_same_bytes,
    fly,
    make_motored,
    with_fixed_link,
    with_plugins,
)
from vehicles import plugin, start

import quadcore as qc

pytestmark = pytest.mark.usefixtures("hook_plugins")


@pytest.mark.parametrize("engine", ENGINES)
def test_what_is_carried_flies_as_a_link_of_the_urdf(engine, hangar):
    urdf = make_motored()
    place = tuple(CARGO[axis] for axis in "xyz")
    lumped = hangar(with_fixed_link(urdf, "cargo", 0.23, CARGO_INERTIA, place), G, engine=engine)
    carrying = hangar(with_plugins(urdf, plugin("cargo", CARGO)), G, engine=engine)
    assert carrying.mass == pytest.approx(lumped.mass, rel=1e-15)
    one, other = (
        fly(simulation, 5000, (510, -505, 515, -508)) for simulation in (lumped, carrying)
    )
    apart = np.abs(one.position - other.position).max()
    print(engine, "apart", apart)
    assert apart <= 1e-12
    bare = fly(hangar(urdf, G, engine=engine), 5000, (510, -505, 515, -508))
    assert np.abs(one.position - bare.position).max() > 1


@pytest.mark.parametrize("engine", ENGINES)
def test_after_its_release_the_bare_vehicle_flies_on_from_where_it_was(engine, hangar):
    urdf = make_motored()
    released = hangar(
        with_plugins(urdf, plugin("cargo", {**CARGO, "release": 0.7})), G, engine=engine
    )
    fly(released, 700)
    state = released.state.copy()
    assert released.mass > 1.2
    laden = released.hover_speed
    rest = fly(released, 1500)
    assert released.mass < 1.1
    assert np.all(np.abs(released.hover_speed) < np.abs(laden))
    bare = start(hangar(urdf, G, engine=engine), **{n: getattr(state, n) for n in state.__slots__})
    alone = fly(bare, 1500)
    assert rest.table[1:, 1:].tobytes() == alone.table[1:, 1:].tobytes()  # all but the clock
    # Its frame went on as it did.
    assert np.abs(rest.position[0] - state.position).max() == 0
    assert np.allclose(rest.position[1], state.position + 1e-3 * state.linear_velocity, atol=2e-5)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_flight_is_taken_up_again_across_a_release(engine, hangar):
    urdf = with_plugins(make_motored(), plugin("cargo", {**CARGO, "release": 0.3}))
    simulation = hangar(urdf, G, engine=engine)
    fly(simulation, 200)
    before = simulation.snapshot()
    first = simulation.run(0.3)
    after = simulation.snapshot()
    second = simulation.run(0.2)
    simulation.restore(before)
    assert simulation.mass > 1.2
    assert_same_bytes(first, simulation.run(0.3))
    simulation.restore(before)
    simulation.restore(after)
    assert simulation.mass < 1.1
    assert_same_bytes(second, simulation.run(0.2))
    simulation.reset()
    assert simulation.mass > 1.2
    fresh = hangar(urdf, G, engine=engine)
    assert_same_bytes(fly(simulation, 500), fly(fresh, 500))


@pytest.mark.parametrize(
    ("tags", "says"),
    [
        (
            {"name": "frame"},
            "the carried body 'frame' has the name of a link. Give it another",
        ),
        ({"mass": 1e300, "radius": 1e10}, "the carried body 'cargo' has an impossible inertia"),
    ],
)
def test_what_cannot_be_carried_is_refused_with_the_plugin(tags, says, hangar):
    element = plugin("cargo", {**CARGO, **{k: v for k, v in tags.items() if k != "name"}})
    element = element.replace('name="cargo"', f'name="{tags.get("name", "cargo")}"')
    with pytest.raises(qc.InputError, match=f"plugin '.*' \\(.*libcargo_plugin.so\\): {says}"):
        hangar(with_plugins(make_motored(), element), G)
