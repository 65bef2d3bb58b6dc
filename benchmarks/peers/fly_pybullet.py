"""PyBullet: a frame with four hinges, all forces and motors from Python."""

import tempfile
from pathlib import Path

import pybullet
from flight import judge, phases, vehicle

V = vehicle()
DT = 1e-3
LINK = pybullet.LINK_FRAME


def document():
    def link(name, mass, moments):
        x, y, z = moments
        return (
            f'<link name="{name}"><inertial><mass value="{mass}"/><inertia ixx="{x}" iyy="{y}" '
            f'izz="{z}" ixy="0" ixz="0" iyz="0"/></inertial></link>'
        )

    parts = [link("frame", V["frame_mass"], V["frame_moments"])]
    for i, (x, y, z) in enumerate(V["places"]):
        parts.append(link(f"rotor{i}", V["rotor_mass"], V["rotor_moments"]))
        parts.append(
            f'<joint name="hinge{i}" type="continuous"><parent link="frame"/><child '
            f'link="rotor{i}"/><origin xyz="{x} {y} {z}"/><axis xyz="0 0 1"/></joint>'
        )
    return f'<robot name="quadrotor">{"".join(parts)}</robot>'


def fly(path):
    pybullet.resetSimulation()
    pybullet.setGravity(0, 0, -V["gravity"])
    pybullet.setTimeStep(DT)
    body = pybullet.loadURDF(str(path), V["spawn"], flags=pybullet.URDF_USE_INERTIA_FROM_FILE)
    # What it has of its own: friction in the joints, drag, a limit to their speeds.
    for joint in range(-1, 4):
        pybullet.changeDynamics(
            body, joint, linearDamping=0, angularDamping=0, jointDamping=0, maxJointVelocity=1e4
        )
    off = pybullet.VELOCITY_CONTROL
    pybullet.setJointMotorControlArray(body, range(4), off, forces=[0] * 4)
    speeds = [0.0] * 4
    for wanted, count in phases(V["hover"], DT):
        for _ in range(count):
            air = 0.0
            for i, (spin, w) in enumerate(zip(V["spins"], speeds)):
                force = [0, 0, V["thrust"] * w * w]
                pybullet.applyExternalForce(body, i, force, [0, 0, 0], LINK)
                air -= spin * V["torque"] * w * w
            pybullet.applyExternalTorque(body, -1, [0, 0, air], LINK)
            torques = [V["gain"] * (s * u - w) for s, u, w in zip(V["spins"], wanted, speeds)]
            control = pybullet.TORQUE_CONTROL
            pybullet.setJointMotorControlArray(body, range(4), control, forces=torques)
            pybullet.stepSimulation()
            speeds = [state[1] for state in pybullet.getJointStates(body, range(4))]
    frame, _ = pybullet.getBasePositionAndOrientation(body)
    rotors = [pybullet.getLinkState(body, i)[0] for i in range(4)]
    parts = [(V["frame_mass"], frame)] + [(V["rotor_mass"], rotor) for rotor in rotors]
    return [sum(m * p[axis] for m, p in parts) / V["mass"] for axis in range(3)]


pybullet.connect(pybullet.DIRECT)
with tempfile.TemporaryDirectory() as folder:
    path = Path(folder) / "quadrotor.urdf"
    path.write_text(document())
    judge("its default integrator, forces from Python", DT, 1, lambda: fly(path), repeats=1)
