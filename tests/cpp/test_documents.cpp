#include "quadcore/text_file.hpp"
#include "vehicle.hpp"

using namespace quadcore;
using namespace quadcore::test;

namespace {

std::string refused(const std::string& text) {
  return refusal([&] { read_model({"a.urdf", text}); });
}

}  // namespace

TEST_CASE("a file that cannot be read is named") {
  CHECK(contains(refusal([] { Document::read("/nowhere/a.urdf"); }),
                 "/nowhere/a.urdf: the file cannot be read"));
}

TEST_CASE("only a regular file of a bounded size is read") {
  CHECK(contains(refusal([] { read_text_file("/dev/zero"); }),
                 "/dev/zero: this is not a regular file"));
  CHECK(contains(refusal([] { read_text_file("/"); }), "/: this is a folder"));
  const std::string world = std::string(TEST_DATA) + "/../../worlds/empty.world";
  CHECK(contains(refusal([&] { read_text_file(world, 5); }), "exceeds the limit of 5e-06 MB"));
  CHECK(read_text_file(world).find("<sdf") != std::string::npos);
}

TEST_CASE("malformed XML is refused with its line") {
  CHECK(refused("").rfind("a.urdf:1: the file is empty. Write a <robot> element", 0) == 0);
  CHECK(refused("<robot name='a'>\n<link>\n</robot>").rfind("a.urdf:2: malformed XML", 0) == 0);
  CHECK(refused("no xml").rfind("a.urdf:1: ", 0) == 0);
  CHECK(refused("\n<sdf/>") == "a.urdf:2: the outermost element is <sdf>. Use <robot>.");
}

TEST_CASE("a document type is refused wherever it stands, and no entity is expanded") {
  CHECK(contains(refused("\n<!DOCTYPE robot>\n<robot name='a'/>"), "a.urdf:2: <!DOCTYPE>"));
  CHECK(contains(refused("<!DOCTYPE robot [<!ENTITY a 'b'>]><robot name='&a;'/>"), "entities"));
  CHECK(contains(refused("<!DOCTYPE r SYSTEM 'file:///etc/hostname'><robot/>"), "<!DOCTYPE>"));
}

TEST_CASE("elements nested without end are refused") {
  std::string text = "<robot name='a'>";
  for (int i = 0; i < 100000; ++i) text += "<a>";
  CHECK(contains(refused(text), "nested"));
}

TEST_CASE("an expanded document names the lines it stems from") {
  const Document expanded{"out",
                          "<robot name='a'>\n<lnk/>\n</robot>",
                          {{"a.xacro", 3}, {"b.xacro", 70}, {"a.xacro", 9}}};
  CHECK(expanded.at(2) == "b.xacro:70");
  CHECK(expanded.at(4) == "out:4");
  CHECK(refusal([&] { read_model(expanded); }).rfind("b.xacro:70: <lnk>", 0) == 0);
}

TEST_CASE("a world that says nothing is Gazebo's") {
  const World world = read_world({"a.world", "<sdf><world/></sdf>"});
  CHECK(world.gravity_W == Vector3d(0, 0, -9.8));
  CHECK(world.max_step_size == 0.001);
  CHECK(world.real_time_update_rate == 1000);
  CHECK(world.solver_type == "quick");
  CHECK(world.solver_iterations == 50);
  CHECK(world.solver_sor == 1.3);
  CHECK(world.erp == 0.2);
  CHECK(world.cfm == 0);
  CHECK(world.wind_W == Vector3d::Zero());
  CHECK(world.atmosphere.temperature == 288.15);
  CHECK(world.atmosphere.temperature_gradient == -0.0065);
  CHECK(world.atmosphere.pressure == 101325);
  CHECK(world.atmosphere.density() == doctest::Approx(1.225).epsilon(1e-5));
  CHECK(world.magnetic_field_W == Vector3d(5.5645e-6, 22.8758e-6, -42.3884e-6));
  CHECK_FALSE(world.ground_plane);
}

TEST_CASE("a world says what it says, also in the thesis' spelling") {
  const World world = read_world({"a.world", R"(
    <sdf><world name="w">
      <include><uri>model://sun</uri></include>
      <include><uri>model://ground_plane</uri></include>
      <physics:ode>
        <gravity>1 2 3</gravity>
        <magnetic_field>2e-5 1e-6 -4e-5</magnetic_field>
        <updateRate>250</updateRate>
        <max_step_size>0.004</max_step_size>
        <real_time_factor>2</real_time_factor>
        <ode>
          <solver><type>world</type><iters>20</iters><sor>1.1</sor></solver>
          <constraints><erp>0.3</erp><cfm>1e-6</cfm></constraints>
        </ode>
      </physics:ode>
      <wind><linear_velocity>4 5 6</linear_velocity></wind>
      <atmosphere type="adiabatic">
        <temperature>300</temperature>
        <temperature_gradient>-0.005</temperature_gradient>
        <pressure>90000</pressure>
      </atmosphere>
    </world></sdf>)"});
  CHECK(world.gravity_W == Vector3d(1, 2, 3));
  CHECK(world.real_time_update_rate == 250);
  CHECK(world.max_step_size == 0.004);
  CHECK(world.solver_type == "world");
  CHECK(world.solver_iterations == 20);
  CHECK(world.solver_sor == 1.1);
  CHECK(world.erp == 0.3);
  CHECK(world.cfm == 1e-6);
  CHECK(world.wind_W == Vector3d(4, 5, 6));
  CHECK(world.atmosphere.temperature == 300);
  CHECK(world.atmosphere.temperature_gradient == -0.005);
  CHECK(world.atmosphere.pressure == 90000);
  CHECK(world.magnetic_field_W == Vector3d(2e-5, 1e-6, -4e-5));
  CHECK(world.ground_plane);
}

TEST_CASE("a world is read as Gazebo reads it, and what nothing feels is listed") {
  const auto read = [](const std::string& version, const std::string& inside) {
    return read_world(
        {"a.world", "<sdf version='" + version + "'><world name='w'>" + inside + "</world></sdf>"});
  };
  const std::string physics = "<physics type='ode'><gravity>0 0 -1</gravity></physics>";
  const std::string own = "<gravity>0 0 -2</gravity>";

  // Gazebo moves the gravity of <physics> to the world when it converts SDF 1.5 and older.
  for (const std::string version : {"1.2", "1.4", "1.5"}) {
    CHECK(read(version, physics).gravity_W.z() == -1);
  }
  for (const std::string version : {"1.6", "1.7", "1.10"}) {
    const World world = read(version, physics);
    CHECK(world.gravity_W.z() == -9.8);
    CHECK(contains(world.ignored_elements.warning(), "<gravity> in <physics> (a.world:1)"));
  }
  CHECK(read("1.5", physics + own).gravity_W.z() == -2);
  CHECK(read("1.6", own + "<gravity>0 0 -3</gravity>").gravity_W.z() == -2);
  CHECK(read("1.6", "<gravity xyz='0 0 -9.81'/>").gravity_W.z() == -9.8);
  CHECK(read("1.5", "<physics><magnetic_field>1 2 3</magnetic_field></physics>").magnetic_field_W ==
        Vector3d(1, 2, 3));

  const auto step = [&](const std::string& version, const std::string& inside) {
    return read(version, inside).max_step_size;
  };
  const std::string dt = "<physics><ode><solver><dt>0.002</dt></solver></ode></physics>";
  CHECK(step("1.3", dt) == 0.002);
  CHECK(step("1.6", dt) == 0.001);
  const auto named = [](const std::string& attributes, const std::string& size) {
    return "<physics " + attributes + "><max_step_size>" + size + "</max_step_size></physics>";
  };
  CHECK(step("1.6", named("name='a'", "0.002") + named("name='b'", "0.003")) == 0.002);
  CHECK(step("1.6", named("name='a'", "0.002") + named("name='b' default='1'", "0.003")) == 0.003);
  CHECK(step("1.6", named("", "0.002") + named("", "0.003")) == 0.003);

  CHECK(read("1.6", "<wind/>").wind_W == Vector3d::Zero());
  CHECK(read("1.6", "<wind><linear_velocity>1 0 0</linear_velocity></wind><wind/>").wind_W.x() ==
        1);
  const std::string rate = "<physics><real_time_update_rate>-1</real_time_update_rate></physics>";
  CHECK(read("1.6", rate).real_time_update_rate == 0);

  const std::string warning =
      read("1.9",
           "stray <joint/><physics update_rate='9'><ode><solver><precon_iters>3"
           "</precon_iters></solver></ode></physics>")
          .ignored_elements.warning();
  CHECK(warning ==
        "ignored, because it does not affect the motion: text in <world> (a.world:1), <joint> "
        "(a.world:1), attribute update_rate of <physics> (a.world:1), <precon_iters> (a.world:1).");
}

TEST_CASE("a plane in line is the ground plane") {
  const World world = read_world({"a.world", R"(<sdf><world>
    <model name="ground"><static>1</static><link name="l">
      <collision name="c"><geometry>
        <plane><normal>0 0 1</normal><size>100 100</size></plane>
      </geometry></collision>
      <visual name="v"><geometry><plane/></geometry></visual>
    </link></model></world></sdf>)"});
  CHECK(world.ground_plane);
}
