#include "quadcore/plugin/world.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "element_rows.hpp"
#include "included_models.hpp"
#include "quadcore/harmless_elements.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin/model.hpp"
#include "quadcore/text.hpp"
#include "sdf_models.hpp"
#include "sdf_version.hpp"
#include "xml.hpp"

namespace quadcore {
namespace {

using Element = Xml::Element;
using Row = ElementRow;
using Handler = std::function<void(const Element&)>;
/// Elements that may repeat.
const std::set<std::string> repeatable = {"include", "model", "physics", "plugin"};

/// Elements that read_models() reads.
const std::set<std::string> of_models = {"include", "model", "state"};

/// Attributes allowed on an element with children.
std::set<std::string> attributes_of(const std::string& element) {
  if (element == "sdf") return {"version"};
  if (element == "atmosphere") return {"type"};
  if (element == "physics" || element == "physics:ode") return {"name", "default", "type"};
  if (element == "world") return {"name"};
  return {};
}

/// Return whether an obstacle is the ground: a level plane at z = 0.
bool is_ground(const Obstacle& obstacle) {
  return obstacle.kind == ShapeKind::plane && obstacle.position_W.z() == 0 &&
         obstacle.size.normalized() == Vector3d::UnitZ() && obstacle.slip1 == 0 &&
         obstacle.slip2 == 0;
}

/// Reads the elements of a world file into a World.
class WorldReader {
 public:
  WorldReader(const Document& document, const std::vector<std::string>& ignore)
      : xml_(document, "sdf", world_.ignored_elements) {
    world_.ignored_elements = IgnoredElements(ignore);
  }

  World read() {
    xml_.only_attributes(xml_.root(), {"version"});
    const std::vector<const Element*> worlds = xml_.children(xml_.root(), {"world"}, {"world"});
    if (worlds.size() > 1) {
      xml_.fail(*worlds[1], "a second <world> in <sdf>. Keep one of them.");
    }
    const Element& world = xml_.required_child(xml_.root(), "world");
    physics_ = choose_physics(world);
    read_children(world, "");
    read_models_of(world);
    return world_;
  }

  const std::vector<Row>& rows() const { return rows_; }

 private:
  using T = TagSpec;

  /// Read the children of the element at a path, which ends with / unless it is empty.
  void read_children(const Element& element, const std::string& path) {
    xml_.only_attributes(element, attributes_of(element.Name()));
    std::set<std::string> names;
    for (const Row& row : rows_) {
      const std::string& name = row.spec.name;
      if (name.rfind(path, 0) != 0) continue;
      names.insert(name.substr(path.size(), name.find('/', path.size()) - path.size()));
    }
    for (const Element* child : xml_.children(element, names, repeatable)) {
      const std::string name = path + child->Name();
      if (of_models.count(name)) continue;
      const auto row = std::find_if(rows_.begin(), rows_.end(),
                                    [&](const Row& r) { return r.spec.name == name; });
      if (row == rows_.end()) {
        read_children(*child, name + "/");
      } else {
        row->read(*child);
      }
    }
  }

  Row update_rate(const char* path, const char* meaning) {
    Row row = elements_.number(path, "1/s", world_.real_time_update_rate, {}, meaning);
    row.read = [this, read = row.read](const Element& e) {
      read(e);
      if (world_.real_time_update_rate >= 0) return;
      elements_.skip(e, "negative <" + std::string(e.Name()) + ">");
      world_.real_time_update_rate = 0;
    };
    return row;
  }

  /// A value of <physics> that Gazebo moves to another element when it converts an old file.
  /// \param minor  SDF 1.`minor` is the last version with that element
  /// \param is_set  returns whether the file has the other element, which wins
  Row moved(Row row, int minor, const std::function<bool()>& is_set) {
    row.read = [this, read = row.read, minor, is_set](const Element& e) {
      if (!is_at_most_sdf(xml_, e, minor) || is_set()) return elements_.skip_here(e);
      read(e);
    };
    return row;
  }
  std::function<bool()> world_has(const char* name) {
    return [this, name] { return xml_.child(*physics_->Parent()->ToElement(), name) != nullptr; };
  }
  std::function<bool()> physics_has(const char* name) {
    return [this, name] { return xml_.child(*physics_, name) != nullptr; };
  }

  std::vector<Row> table() {
    Atmosphere& air = world_.atmosphere;
    Origin& origin = world_.origin;
    const Handler ignored = [](const Element&) {};
    const Handler physics = [this](const Element& e) { read_physics(e); };
    Row solver =
        elements_.word(T::choice("physics/ode/solver/type", {"quick", "world"},
                                 "solver of the constraints; both give the same result in flight, "
                                 "see [gazebo.md](gazebo.md)"));
    solver.read = [this, check = solver.read](const Element& e) {
      check(e);
      if (!xml_.text(e).empty()) world_.solver_type = xml_.text(e);
      world_.solver_type_where = xml_.where(e);
    };
    const Row iterations = {
        T::number("physics/ode/solver/iters", "", std::to_string(world_.solver_iterations),
                  "iterations of the quick solver, a whole number")
            .at_least(1)
            .at_most(1e6),
        [this](const Element& e) {
          if (elements_.is_empty(e)) return;
          const double value = xml_.number_in_text(e);
          if (!(value >= 1 && value <= 1e6) || value != std::floor(value)) {
            xml_.fail(e, "<iters> is out of range. Use a whole number from 1 to 1000000.");
          }
          world_.solver_iterations = static_cast<int>(value);
        }};
    return {
        elements_.vector("gravity", "m/s^2", world_.gravity_W, "gravity in world axes"),
        elements_.vector(
            "wind/linear_velocity", "m/s", world_.wind_W,
            "velocity of the air in world axes; acts only with `<dragModel>` `chapter2`"),
        elements_.other(
            "atmosphere",
            "attribute `type`, if given, must be `adiabatic`; used by plugins with a tag for it",
            [this](const Element& e) { read_atmosphere(e); }),
        elements_.number("atmosphere/temperature", "K", air.temperature, elements_.above(0),
                         "temperature of the air at z = 0"),
        elements_.number("atmosphere/temperature_gradient", "K/m", air.temperature_gradient, {},
                         "change of the temperature with height"),
        elements_.number("atmosphere/pressure", "Pa", air.pressure, {0},
                         "pressure of the air at z = 0"),
        elements_.vector(
            "magnetic_field", "T", world_.magnetic_field_W,
            "the Earth's magnetic field in world axes (x east, y north, z up), for magnetometers"),
        elements_.word(T::choice("spherical_coordinates/surface_model", {"EARTH_WGS84"},
                                 "reference ellipsoid")),
        elements_.word(T::choice("spherical_coordinates/world_frame_orientation", {"ENU"},
                                 "world axes: x east, y north, z up")),
        elements_.number(
            "spherical_coordinates/latitude_deg", "deg", origin.latitude, {-90, 90},
            "latitude of the world's origin, positive north, for RotorS' GPS receiver"),
        elements_.number(
            "spherical_coordinates/longitude_deg", "deg", origin.longitude, {-180, 180},
            "longitude of the world's origin, positive east, for RotorS' GPS receiver"),
        elements_.number("spherical_coordinates/elevation", "m", origin.altitude, {-1e5, 1e7},
                         "altitude of the world's origin"),
        elements_.number("spherical_coordinates/heading_deg", "deg", origin.heading, {-360, 360},
                         "rotation of the world's axes; RotorS' GPS receiver accepts only 0"),
        elements_.other(
            "state",
            "state of a saved world: its poses and scales replace those of the models, its "
            "insertions are added and its deletions removed, and the time starts at `sim_time`",
            ignored),
        elements_.other(
            "include/uri",
            "`model://NAME` on GAZEBO_MODEL_PATH, in ~/.gazebo/models or in ROS packages, "
            "`package://`, `file://`; `model://ground_plane` and `model://sun` are built in",
            ignored),
        elements_.other("include/name", "replaces the name of the model", ignored),
        elements_.other("include/pose", "replaces the pose of the model", ignored),
        elements_.other("include/static", "replaces `static` of the model", ignored),
        elements_.other(
            "plugin",
            "skipped. A warning, the summary and the log name a module that does more than sense "
            "or publish, see below",
            [this](const Element& e) { skip_plugin(xml_, e, ""); }),
        elements_.other(
            "model",
            "a model of boxes, cylinders, spheres, planes, meshes and polylines that is static or "
            "moves freely or on "
            "joints. The second of two models with one name is ignored, and so is a model without "
            "collision shapes",
            ignored),
        elements_.other("physics",
                        "attribute `type`, if given, must be `ode`; also written `physics:ode`",
                        physics),
        elements_.other("physics:ode", "", physics),
        moved(elements_.vector(
                  "physics/gravity", "m/s^2", world_.gravity_W,
                  "up to SDF 1.5: `gravity`, unless the world has it; ignored from SDF 1.6 on, "
                  "as in Gazebo"),
              5, world_has("gravity")),
        moved(elements_.vector(
                  "physics/magnetic_field", "T", world_.magnetic_field_W,
                  "up to SDF 1.5: `magnetic_field`, unless the world has it; ignored from SDF "
                  "1.6 on, as in Gazebo"),
              5, world_has("magnetic_field")),
        elements_.number("physics/max_step_size", "s", world_.max_step_size, {shortest_step},
                         "time step, unless `--dt` or `dt=` sets it"),
        moved(elements_.number("physics/ode/solver/dt", "s", world_.max_step_size, {shortest_step},
                               "up to SDF 1.3: `physics/max_step_size`; ignored from SDF 1.4 on"),
              3, physics_has("max_step_size")),
        update_rate("physics/real_time_update_rate",
                    "steps per second of wall-clock time for ROS nodes; 0 or less: as fast as "
                    "possible"),
        update_rate("physics/updateRate", "the thesis' name for `real_time_update_rate`"),
        moved(update_rate("physics/update_rate",
                          "up to SDF 1.3: `real_time_update_rate`; ignored from SDF 1.4 on"),
              3, physics_has("real_time_update_rate")),
        elements_.number("physics/real_time_factor", "", real_time_factor_, {},
                         "no effect, as in Gazebo; use `real_time_update_rate`"),
        elements_.other("physics/max_contacts",
                        "upper limit of the contact points of a pair of shapes, a whole number",
                        [this](const Element& e) { read_max_contacts(e); }),
        elements_.word(T::choice("physics/ode/solver/friction_model", {"pyramid_model"},
                                 "model of dry friction")),
        solver,
        iterations,
        elements_.number("physics/ode/solver/sor", "", world_.solver_sor, elements_.above(0, 2),
                         "over-relaxation of the quick solver"),
        elements_.other("physics/ode/solver/use_dynamic_moi_rescaling",
                        "1 is not simulated: no engine rescales moments of inertia",
                        [this](const Element& e) {
                          if (elements_.is_empty(e) || xml_.text(e) == "0" ||
                              xml_.text(e) == "false")
                            return;
                          if (xml_.ignored_elements().ignores({e.Name()})) return;
                          xml_.ignored_elements().add_unsimulated(e.Name(), xml_.where(e));
                        }),
        elements_.number("physics/ode/constraints/erp", "", world_.erp, {0, 1},
                         "fraction of a hinge's error that a step removes"),
        elements_.number("physics/ode/constraints/cfm", "", world_.cfm, {0},
                         "softness of the hinges"),
        elements_.number(
            "physics/ode/constraints/contact_max_correcting_vel", "m/s",
            world_.contact_max_correcting_vel, {0},
            "upper limit of a contact's `maxVel`; in `gazebo11` also of a hinge's correcting "
            "velocity, see [gazebo.md](gazebo.md#random-vehicles)"),
    };
  }

  /// Reject a value that is given in two places.
  void refuse_both(const Element* first, const Element* second) {
    if (!first || !second) return;
    xml_.fail(*second, "<" + std::string(second->Name()) + "> sets the same value as <" +
                           first->Name() + "> (" + xml_.where(*first) + "). Keep one of them.");
  }

  /// Reject an attribute `type` other than the supported one, unless the user ignores it.
  void only_type(const Element& e, const std::string& supported) {
    const char* type = e.Attribute("type");
    if (!type || type == supported || xml_.ignored_elements().ignores({type})) return;
    xml_.fail(e, std::string(e.Name()) + " type '" + type + "' is not supported. Use " + supported +
                     "." + suggest_ignoring(type));
  }

  /// Return the <physics> that Gazebo uses: the default one, else the last with the first one's
  /// name.
  const Element* choose_physics(const Element& world) {
    const Element* const first = xml_.child(world, "physics");
    refuse_both(first, xml_.child(world, "physics:ode"));
    const auto name_of = [](const Element& e) {
      const char* name = e.Attribute("name");
      return std::string(name ? name : "");
    };
    const Element* chosen = first ? first : xml_.child(world, "physics:ode");
    for (const Element* e = first; e; e = e->NextSiblingElement("physics")) {
      if (e->BoolAttribute("default")) return e;
      if (name_of(*e) == name_of(*first)) chosen = e;
    }
    return chosen;
  }

  void read_physics(const Element& physics) {
    if (&physics != physics_) return elements_.skip(physics, "a further <physics>");
    refuse_both(xml_.child(physics, "real_time_update_rate"), xml_.child(physics, "updateRate"));
    only_type(physics, "ode");
    read_children(physics, "physics/");
  }

  void read_max_contacts(const Element& e) {
    if (elements_.is_empty(e)) return;
    const double value = xml_.number_in_text(e);
    if (!(value >= 0 && value <= 1e6) || value != std::floor(value)) {
      xml_.fail(e, "<max_contacts> is out of range. Use a whole number from 0 to 1000000.");
    }
    world_.max_contacts = static_cast<int>(value);
  }

  void read_atmosphere(const Element& atmosphere) {
    only_type(atmosphere, "adiabatic");
    read_children(atmosphere, "atmosphere/");
  }

  void read_models_of(const Element& world) {
    const WorldModels models = read_models(xml_, world);
    world_.start_time = models.start_time;
    world_.ignored_models = models.ignored;
    world_.free_bodies = models.free_bodies;
    world_.free_joints = models.free_joints;
    for (const Obstacle& obstacle : models.obstacles) {
      if (world_.ground_plane || !is_ground(obstacle)) {
        world_.obstacles.push_back(obstacle);
        continue;
      }
      world_.ground_plane = true;
      world_.ground = obstacle.surface;
    }
  }

  World world_;
  double real_time_factor_ = 1;
  const Element* physics_ = nullptr;  ///< the <physics> that is read
  Xml xml_;
  ElementRows elements_{xml_};
  std::vector<Row> rows_ = table();
};

}  // namespace

World read_world(const Document& document, const std::vector<std::string>& ignore) {
  const Document whole = embed_models(document, ignore);
  World world = WorldReader(whole, ignore).read();
  world.source = std::make_shared<Source>(Source{whole, ignore});
  return world;
}

std::vector<TagSpec> world_elements() {
  std::vector<TagSpec> elements;
  const Document empty{"", "<sdf/>"};
  const WorldReader reader(empty, {});
  for (const Row& row : reader.rows()) {
    if (!row.spec.meaning.empty()) elements.push_back(row.spec);
  }
  return elements;
}

}  // namespace quadcore
