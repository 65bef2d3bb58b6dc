#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin/world.hpp"
#include "sdf_models.hpp"

using namespace quadcore;

namespace {

std::string refusal_of_world(const std::string& text, const std::vector<std::string>& ignore = {}) {
  try {
    read_world({"a.world", text}, ignore);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

struct Reading {
  IgnoredElements ignored;
  WorldModels models;
};

/// Read what stands in the `<world>` of SDF 1.6, or of another version.
Reading read_inside(const std::string& inside, const std::string& version = "1.6",
                    const std::vector<std::string>& ignore = {}) {
  const Document document{
      "a.world", "<sdf version='" + version + "'><world name='w'>\n" + inside + "</world></sdf>"};
  Reading reading{IgnoredElements(ignore), {}};
  const Xml xml(document, "sdf", reading.ignored);
  reading.models = read_models(xml, *xml.child(xml.root(), "world"));
  return reading;
}

std::string refusal_inside(const std::string& inside, const std::string& version = "1.6") {
  try {
    read_inside(inside, version);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string collision(const std::string& shape, const std::string& more = "") {
  return "<collision name='c'>" + more + "<geometry>" + shape + "</geometry></collision>";
}

std::string box_model(const std::string& name, const std::string& pose,
                      const std::string& link_pose = "") {
  return "<model name='" + name + "'><static>1</static><pose>" + pose +
         "</pose><link name='l'><pose>" + link_pose + "</pose>" +
         collision("<box><size>1 2 3</size></box>") + "</link></model>";
}

void check_near(const Vector3d& a, const Vector3d& b) { CHECK((a - b).norm() < 1e-12); }

/// The shape of a plane model; its normal, and z of its pose.
Obstacle plane_of(const std::string& inside) { return read_inside(inside).models.obstacles.at(0); }

}  // namespace

TEST_CASE("poses of model, link and collision are composed") {
  const std::string pose = "<pose>0 0 3 0 0 0</pose>";
  const Reading reading = read_inside(
      "<model name='m'><static>true</static><pose>1 2 0 0 0 1.5707963267948966</pose>"
      "<link name='l'><pose>1 0 0 0 1.5707963267948966 0</pose>" +
      collision("<box/>", pose) + "</link></model>");
  const Obstacle& box = reading.models.obstacles.at(0);
  // Turned by yaw, the link is at (1, 3, 0); its z axis, pitched first, points to the world's y.
  check_near(box.position_W, {1, 6, 0});
  check_near(box.orientation_W * Vector3d::UnitZ(), {0, 1, 0});
  CHECK(box.model == "m");
  CHECK(box.name == "l::c");
  CHECK(box.size == Vector3d::Ones());  // SDF's default
  CHECK(box.where == "a.world:2");
}

TEST_CASE("state wins over pose, wherever it stands") {
  const std::string state =
      "<state><sim_time>12 340000000</sim_time>"
      "<model name='m'><pose>5 0 0 0 0 0</pose><scale>2 1 3</scale></model>"
      "<model name='unknown'><pose>9 9 9 0 0 0</pose></model></state>"
      "<state><model name='m'><pose>7 7 7 0 0 0</pose></model></state>";
  for (const bool first : {true, false}) {
    const std::string models =
        box_model("m", "1 0 0 0 0 0", "0 1 0 0 0 0") + box_model("kept", "3 0 0 0 0 0");
    const WorldModels read = read_inside(first ? state + models : models + state).models;
    CHECK(read.start_time == 12.34);
    check_near(read.obstacles.at(0).position_W, {5, 1, 0});
    check_near(read.obstacles.at(0).size, {2, 2, 9});
    check_near(read.obstacles.at(1).position_W, {3, 0, 0});
  }
}

TEST_CASE("the state of a link alone moves the model") {
  const std::string two_links =
      "<model name='m'><static>1</static><link name='a'><pose>1 0 0 0 0 0</pose>" +
      collision("<sphere/>") + "</link><link name='b'><pose>0 1 0 0 0 0</pose>" +
      collision("<sphere/>") + "</link></model>";
  const auto place = [&](const std::string& link) {
    return read_inside(two_links + "<state><model name='m'><link name='" + link +
                       "'><pose>10 0 0 0 0 0</pose></link></model></state>")
        .models.obstacles;
  };
  check_near(place("a").at(0).position_W, {10, 0, 0});
  check_near(place("a").at(1).position_W, {9, 1, 0});
  check_near(place("b").at(0).position_W, {1, 0, 0});
  check_near(place("b").at(1).position_W, {10, 0, 0});
}

TEST_CASE("insertions are added and deletions removed") {
  const WorldModels read =
      read_inside(box_model("a", "1 0 0 0 0 0") + box_model("b", "2 0 0 0 0 0") +
                  "<state><insertions>" + box_model("c", "3 0 0 0 0 0") +
                  "</insertions><deletions><name>a</name></deletions></state>")
          .models;
  REQUIRE(read.obstacles.size() == 2);
  CHECK(read.obstacles[0].model == "b");
  CHECK(read.obstacles[1].model == "c");
}

TEST_CASE("of a plane only the normal and z count, and no state moves it") {
  const auto plane = [](const std::string& fixed) {
    return "<model name='p'><static>" + fixed +
           "</static><pose>1 2 0.5 1 0 0</pose><link name='l'>" +
           collision("<plane><normal>1 0 0</normal></plane>") + "</link></model>";
  };
  const std::string state = "<state><model name='p'><pose>0 0 9 0 0 0</pose></model></state>";
  for (const std::string fixed : {"1", "0"}) {  // in a free model it stands still all the same
    for (const std::string& inside : {plane(fixed), plane(fixed) + state}) {
      const Obstacle shape = plane_of(inside);
      CHECK(shape.size == Vector3d::UnitX());
      CHECK(shape.position_W.z() == 0.5);
    }
  }
}

TEST_CASE("the second of two models with one name is dropped, with a warning") {
  const Reading reading =
      read_inside(box_model("m", "1 0 0 0 0 0") + box_model("m", "2 0 0 0 0 0") +
                  "<include><uri>model://ground_plane</uri></include>"
                  "<include><uri>model://ground_plane</uri></include>"
                  "<include><uri>model://ground_plane</uri><name>other</name>"
                  "<pose>0 0 -1 0 0 0</pose></include>");
  REQUIRE(reading.models.obstacles.size() == 3);
  CHECK(reading.models.obstacles[0].position_W.x() == 1);
  CHECK(reading.models.obstacles[1].model == "ground_plane");
  CHECK(reading.models.obstacles[1].surface.mu1 == 100);
  CHECK(reading.models.obstacles[2].model == "other");
  CHECK(reading.models.obstacles[2].position_W.z() == -1);
  CHECK(has(reading.ignored.warning(), "a second model 'm' (a.world:2)"));
  CHECK(has(reading.ignored.warning(), "a second model 'ground_plane'"));
}

TEST_CASE("what a static surface contributes to a contact is read") {
  const auto surface = [](const std::string& more) {
    return plane_of("<model name='m'><static>1</static><link name='l'>" +
                    collision("<box/>", more) + "</link></model>")
        .surface;
  };
  CHECK(surface("").mu1 == 1);
  CHECK(surface("").max_contacts == 10);
  const Surface read = surface(
      "<max_contacts>4</max_contacts><surface><friction><ode><mu>0.5</mu><mu2>0.25</mu2>"
      "<fdir1>1 0 "
      "0</fdir1></ode><torsional><ode/></torsional></friction><contact><ode><kp>1e13</kp>"
      "<kd>7</kd><max_vel>9</max_vel><min_depth>1</min_depth></ode></contact><bounce/></surface>");
  CHECK(read.mu1 == 0.5);
  CHECK(read.mu2 == 0.25);
  CHECK(read.fdir1 == Vector3d::UnitX());
  CHECK(read.kp == 1e13);
  CHECK(read.kd == 7);
  CHECK(read.max_vel == Surface().max_vel);  // a static body has no say
  CHECK(read.min_depth == Surface().min_depth);
  CHECK(read.max_contacts == 4);
}

TEST_CASE("a nested model collides, and stands still with its parent") {
  const WorldModels read = read_inside(
                               "<model name='outer'><static>1</static><pose>1 0 0 0 0 0</pose>"
                               "<model name='inner'><pose>0 2 0 0 0 0</pose><link name='l'>" +
                               collision("<sphere/>") + "</link></model></model>")
                               .models;
  CHECK(read.obstacles.at(0).model == "outer::inner");
  check_near(read.obstacles[0].position_W, {1, 2, 0});
  const WorldModels moves =
      read_inside(
          "<model name='outer'><static>1</static><model name='inner'><static>0</static><link "
          "name='l'>" +
          collision("<sphere/>") + "</link></model></model>")
          .models;
  CHECK(moves.obstacles.empty());
  CHECK(moves.free_bodies.at(0).model == "outer::inner");
}

TEST_CASE("frames are resolved from SDF 1.7 on, and ignored before") {
  const std::string inside =
      "<frame name='f'><pose>0 0 5 0 0 0</pose></frame>"
      "<model name='m'><static>1</static><pose relative_to='f'>1 0 0 0 0 0</pose>"
      "<frame name='g'><pose>0 1 0 0 0 0</pose></frame>"
      "<link name='l'><pose relative_to='g'>0 1 0 0 0 0</pose>" +
      collision("<sphere/>", "<pose relative_to='g'>0 0 1 0 0 0</pose>") + "</link></model>";
  check_near(read_inside(inside, "1.7").models.obstacles.at(0).position_W, {1, 1, 6});
  check_near(read_inside(inside, "1.6").models.obstacles.at(0).position_W, {1, 1, 1});
  const std::string loop =
      "<model name='m'><static>1</static><frame name='a'><pose relative_to='b'/></frame>"
      "<frame name='b'><pose relative_to='a'/></frame><link name='l'><pose relative_to='a'/></link>"
      "</model>";
  CHECK(has(refusal_inside(loop, "1.7"), "is relative to itself"));
  CHECK(has(refusal_inside("<model name='m'><link name='l'><pose relative_to='x'/></link></model>",
                           "1.7"),
            "the frame 'x' does not exist"));
}

TEST_CASE("models that nothing feels are accepted, others name the remedy") {
  const std::string camera =
      "<model name='camera'><link name='l'><visual name='v'/><sensor name='s'/></link></model>";
  const std::string felt_by_nothing =
      camera + "<model name='ghost'><static>1</static><link name='l'>" +
      collision("<box/>",
                "<surface><contact><collide_without_contact>1</collide_without_contact>"
                "</contact></surface>") +
      collision("<box/>",
                "<surface><contact><collide_bitmask>0</collide_bitmask></contact>"
                "</surface>") +
      collision("<empty/>") + "</link></model><light/><actor/><road/>";
  CHECK(read_inside(felt_by_nothing).models.obstacles.empty());

  const std::string free =
      "\n<model name='crate'><link name='l'>" + collision("<box/>") + "</link></model>";
  const FreeBody body = read_inside(free).models.free_bodies.at(0);
  CHECK(body.inertial.mass == 1);
  CHECK(body.inertial.inertia == Matrix3d::Identity());
  CHECK(body.shapes.at(0).name == "l::c");
  CHECK(read_inside(free, "1.6", {"crate"}).models.ignored == std::vector<std::string>{"crate"});
}

TEST_CASE("a joint of free bodies has its anchor and axis in both links") {
  const std::string inside =
      "<model name='m'><pose>1 0 0 0 0 0</pose>"
      "<link name='a'>" +
      collision("<box/>") + "</link><link name='b'><pose>0 0 2 0 0 1.5707963267948966</pose>" +
      collision("<box/>") +
      "</link><joint name='j' type='revolute'><parent>a</parent><child>b</child>"
      "<pose>0 0 -1 0 0 0</pose><axis><xyz>1 0 0</xyz>";
  const std::string end = "</axis></joint></model>";
  const FreeJoint joint = read_inside(inside + end).models.free_joints.at(0);
  CHECK(joint.name == "m::j");
  check_near(joint.anchor_C, {0, 0, -1});
  check_near(joint.anchor_P, {0, 0, 1});
  check_near(joint.axis_C, {1, 0, 0});
  check_near(joint.axis_P, {0, 1, 0});
  // In the model's axes.
  const std::string in_model = inside + "<use_parent_model_frame>1</use_parent_model_frame>" + end;
  check_near(read_inside(in_model).models.free_joints.at(0).axis_P, {1, 0, 0});
  check_near(read_inside(inside + end, "1.4").models.free_joints.at(0).axis_P, {1, 0, 0});
}

TEST_CASE("files of SDF 1.0 are converted") {
  const World world = read_world(
      {"a.world",
       "<gazebo version='1.0'><world name='w'><physics type='ode' update_rate='500'>"
       "<gravity xyz='0 0 -3'/><ode><solver dt='0.002' iters='20' sor='1.2'/></ode></physics>"
       "<model name='m' static='true'><origin pose='1 2 3 0 0 0'/><link name='l'>"
       "<collision name='c'><origin pose='0 0 1 0 0 0'/><geometry><box size='1 2 3'/></geometry>"
       "</collision></link></model></world></gazebo>"},
      {});
  CHECK(world.gravity_W == Vector3d(0, 0, -3));
  CHECK(world.max_step_size == 0.002);
  CHECK(world.solver_iterations == 20);
  CHECK(world.real_time_update_rate == 500);
  check_near(world.obstacles.at(0).position_W, {1, 2, 4});
  CHECK(world.obstacles[0].size == Vector3d(1, 2, 3));
}

TEST_CASE("a bad number in a model is one line with its place") {
  const auto model = [](const std::string& pose, const std::string& shape) {
    return refusal_inside("<model name='m'><static>1</static>" + pose + "<link name='l'>" +
                          collision(shape) + "</link></model>");
  };
  CHECK(has(model("<pose>0 0 nan 0 0 0</pose>", "<box/>"), "a.world:2: <pose> is '0 0 nan 0 0 0'"));
  CHECK(has(model("<pose>0 0 0</pose>", "<box/>"), "Write six finite numbers"));
  CHECK(has(model("", "<box><size>0 1 1</size></box>"), "<size> is not positive"));
  CHECK(has(model("", "<sphere><radius>-1</radius></sphere>"), "<radius> is not positive"));
  CHECK(has(model("", "<cylinder><radius>1</radius><length>0</length></cylinder>"), "<length> is"));
  CHECK(has(model("", "<plane><normal>0 0 0</normal></plane>"), "<normal> is zero"));
}

TEST_CASE("models are included from GAZEBO_MODEL_PATH") {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / "quadcore_test_sdf_models";
  fs::remove_all(folder);
  const auto write = [&](const std::string& name, const std::string& file,
                         const std::string& text) {
    fs::create_directories(folder / name);
    std::ofstream(folder / name / file) << text;
  };
  const auto sdf = [](const std::string& inside) {
    return "<sdf version='1.5'>\n<model name='own'>" + inside + "</model></sdf>";
  };
  const std::string link = "<link name='l'>" + collision("<plane/>") + "</link>";
  write("floor", "model.config",
        "<model><sdf version='1.4'>old.sdf</sdf><sdf version='1.5'>new.sdf</sdf>"
        "<sdf version='1.9'>future.sdf</sdf></model>");
  write("floor", "new.sdf", sdf("<static>1</static><pose>0 0 1 0 0 0</pose>" + link));
  write("loop", "model.sdf", sdf("<include><uri>model://loop</uri></include>"));
  write("broken", "model.sdf", "<sdf><model>");
  setenv("GAZEBO_MODEL_PATH", folder.c_str(), 1);

  const auto including = [](const std::string& inside) {
    return "<sdf version='1.6'><world name='w'>\n" + inside + "</world></sdf>";
  };
  const std::string floor = "<uri>model://floor</uri>";
  // The pose of the include replaces that of the model, so that this is the ground.
  const std::string at_zero = "<pose>0 0 0 0 0 0</pose>";
  const World world =
      read_world({"a.world", including("<include>" + floor + at_zero + "</include>")});
  CHECK(world.ground_plane);
  // The text that is kept needs no files.
  fs::remove_all(folder / "floor");
  CHECK(read_world(world.source->document).ground_plane);

  CHECK(has(refusal_of_world(including("<include><uri>model://loop</uri></include>")),
            "model://loop' includes itself. Remove the <include>. To simulate without it, use "
            "--ignore model://loop."));
  const std::string broken =
      refusal_of_world(including("<include><uri>model://broken</uri></include>"));
  CHECK(has(broken, "broken/model.sdf:"));
  CHECK(has(broken, "malformed XML"));
  const std::string missing = including("<include>" + floor + "</include>");
  CHECK(read_world({"a.world", missing}).ignored_elements.unsimulated() ==
        std::vector<std::string>{"the missing model model://floor"});
  const World without = read_world({"a.world", missing}, {"model://floor"});
  CHECK(without.ignored_models == std::vector<std::string>{"model://floor"});
  unsetenv("GAZEBO_MODEL_PATH");
  fs::remove_all(folder);
}

TEST_CASE("ten thousand obstacles are read") {
  std::string inside;
  for (int i = 0; i < 10000; ++i) inside += box_model("b" + std::to_string(i), "1 0 0 0 0 0");
  CHECK(read_inside(inside).models.obstacles.size() == 10000);
}

TEST_CASE("a model that includes itself, on disk or in the document, is one line") {
  const std::string inner =
      "<model name='a'><static>1</static><include><uri>u</uri></include></model>";
  const std::string world = "<include><uri>u</uri><sdf version='1.6'>" + inner + "</sdf></include>";
  CHECK(has(refusal_inside(world), "'u' includes itself. Remove the <include>."));
}

TEST_CASE("a model that one include embeds serves the others, though that one is ignored") {
  const std::string embedded = "<sdf version='1.6'>" + box_model("box", "0 0 1 0 0 0") + "</sdf>";
  const std::string world = "<include><uri>u</uri><name>first</name>" + embedded +
                            "</include><include><uri>u</uri><name>second</name></include>";
  const auto read = read_inside(world, "1.6", {"first"}).models;
  REQUIRE(read.obstacles.size() == 1);
  CHECK(read.obstacles[0].model == "second");
  CHECK(read.ignored == std::vector<std::string>{"first"});
}

TEST_CASE("a contact without stiffness and damping, and a time beyond all clocks, are refused") {
  const std::string soft = "<surface><contact><ode><kp>0</kp><kd>0</kd></ode></contact></surface>";
  CHECK(has(refusal_inside("<model name='m'><static>1</static><link name='l'>" +
                           collision("<box><size>1 2 3</size></box>", soft) + "</link></model>"),
            "<kp> and <kd> are both 0."));
  CHECK(has(refusal_inside("<state world_name='w'><sim_time>0 1e300</sim_time></state>"),
            "Write seconds and nanoseconds."));
}
