"""The quadrotor in MuJoCo: a frame with four hinges, and motors as its actuators."""

from flight import vehicle

V = vehicle()
DT = 1e-3


def text(numbers):
    return " ".join(repr(float(number)) for number in numbers)


def document(integrator):
    rotor = (
        '<body pos="{place}"><joint name="rotor{i}" type="hinge" axis="0 0 1"/>'
        '<inertial pos="0 0 0" mass="{mass}" diaginertia="{moments}"/></body>'
    )
    rotors = "".join(
        rotor.format(i=i, place=text(place), mass=V["rotor_mass"], moments=text(V["rotor_moments"]))
        for i, place in enumerate(V["places"])
    )
    motors = "".join(f'<velocity joint="rotor{i}" kv="{V["gain"]}"/>' for i in range(4))
    return f"""
      <mujoco>
        <option timestep="{DT}" integrator="{integrator}" gravity="0 0 {-V["gravity"]}">
          <flag contact="disable" constraint="disable"/>
        </option>
        <worldbody>
          <body pos="{text(V["spawn"])}"><freejoint/>
            <inertial pos="0 0 0" mass="{V["frame_mass"]}"
              diaginertia="{text(V["frame_moments"])}"/>
            {rotors}
          </body>
        </worldbody>
        <actuator>{motors}</actuator>
      </mujoco>"""
