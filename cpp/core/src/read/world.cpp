#include "quadcore/plugin/world.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "quadcore/harmless_elements.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/text.hpp"
#include "xml.hpp"

namespace quadcore {
namespace {

using Element = Xml::Element;
using Handler = std::function<void(const Element&)>;

/// An element of a world, named by its path below <world>. An element without a meaning is an
/// alternative name or only groups other elements.
struct Row {
  TagSpec spec;
  Handler read;
};

/// Elements that may repeat.
const std::set<std::string> repeatable = {"include", "model", "plugin", "visual"};

/// Elements that their parent, if present, requires.
constexpr const char* required[] = {"wind/linear_velocity",
                                    "include/uri",
                                    "model/static",
                                    "model/link",
                                    "model/link/collision",
                                    "model/link/collision/geometry",
                                    "model/link/collision/geometry/plane"};

/// Attributes allowed on an element with children.
std::set<std::string> attributes_of(const std::string& element) {
  if (element == "sdf") return {"version"};
  if (element == "atmosphere") return {"type"};
  if (element == "physics" || element == "physics:ode") return {"name", "default", "type"};
  if (element == "world" || element == "model" || element == "link" || element == "collision") {
    return {"name"};
  }
  return {};
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
    xml_.children(xml_.root(), {"world"});
    read_children(xml_.required_child(xml_.root(), "world"), "");
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
      const auto row = std::find_if(rows_.begin(), rows_.end(),
                                    [&](const Row& r) { return r.spec.name == name; });
      if (row == rows_.end()) {
        read_children(*child, name + "/");
      } else {
        row->read(*child);
      }
    }
    for (const std::string needed : required) {
      const std::size_t last = needed.rfind('/') + 1;
      if (needed.substr(0, last) == path) xml_.required_child(element, needed.c_str() + last);
    }
  }

  struct Range {
    double min = -INFINITY, max = INFINITY;
    bool open = false;  ///< excludes min itself
  };
  static Range above(double min, double max = INFINITY) { return {min, max, true}; }

  Row number(std::string path, std::string unit, double& target, const Range& range,
             std::string meaning) {
    std::string fallback;
    append_shortest(target, fallback);
    T spec = T::number(std::move(path), std::move(unit), fallback, std::move(meaning));
    spec.min = range.min, spec.max = range.max, spec.exclusive_min = range.open;
    return {spec, [this, spec, &target](const Element& e) {
              target = xml_.number_in_text(e);
              const bool is_above = spec.exclusive_min ? target > spec.min : target >= spec.min;
              if (is_above && target <= spec.max) return;
              xml_.fail(e, "<" + std::string(e.Name()) + "> is out of range. Use a number " +
                               spec.interval() + ".");
            }};
  }

  Row vector(std::string path, std::string unit, Vector3d& target, std::string meaning) {
    std::string fallback;
    for (int i = 0; i < 3; ++i) {
      append_shortest(target[i], fallback.empty() ? fallback : fallback += ' ');
    }
    return {T::numbers(std::move(path), std::move(unit), fallback, std::move(meaning)).of(3),
            [this, &target](const Element& e) { target = xml_.vector_in_text(e); }};
  }

  Row word(const TagSpec& spec) {
    return {spec, [this, spec](const Element& e) {
              const std::string text = xml_.text(e);
              std::string alternatives;
              for (const std::string& choice : spec.choices) {
                if (text == choice) return;
                alternatives += (alternatives.empty() ? "" : " or ") + choice;
              }
              xml_.fail(e, "<" + std::string(e.Name()) + "> is '" + text + "'. Use " +
                               alternatives + ".");
            }};
  }

  /// An element without a value to show in the table.
  static Row other(std::string path, std::string meaning, Handler read) {
    TagSpec spec = T::text(std::move(path), "", std::move(meaning));
    spec.kind = TagKind::choice;
    return {spec, std::move(read)};
  }

  std::vector<Row> table() {
    Atmosphere& air = world_.atmosphere;
    Origin& origin = world_.origin;
    const Handler ignored = [](const Element&) {};
    const Handler physics = [this](const Element& e) { read_physics(e); };
    Row solver = word(T::choice("physics/ode/solver/type", {"quick", "world"},
                                "solver of the constraints; both give the same result in flight, "
                                "see [gazebo.md](gazebo.md)"));
    solver.read = [this, check = solver.read](const Element& e) {
      check(e);
      world_.solver_type = xml_.text(e);
      world_.solver_type_where = xml_.where(e);
    };
    const Row iterations = {
        T::number("physics/ode/solver/iters", "", std::to_string(world_.solver_iterations),
                  "iterations of the quick solver, a whole number")
            .at_least(1)
            .at_most(1e6),
        [this](const Element& e) {
          const double value = xml_.number_in_text(e);
          if (!(value >= 1 && value <= 1e6) || value != std::floor(value)) {
            xml_.fail(e, "<iters> is out of range. Use a whole number from 1 to 1000000.");
          }
          world_.solver_iterations = static_cast<int>(value);
        }};
    return {
        vector("gravity", "m/s^2", world_.gravity_W, "gravity in world axes"),
        vector("wind/linear_velocity", "m/s", world_.wind_W,
               "velocity of the air in world axes; acts only with `<dragModel>` `chapter2`"),
        other("atmosphere",
              "attribute `type`, if given, must be `adiabatic`; used by plugins with a tag for it",
              [this](const Element& e) { read_atmosphere(e); }),
        number("atmosphere/temperature", "K", air.temperature, above(0),
               "temperature of the air at z = 0"),
        number("atmosphere/temperature_gradient", "K/m", air.temperature_gradient, {},
               "change of the temperature with height"),
        number("atmosphere/pressure", "Pa", air.pressure, {0}, "pressure of the air at z = 0"),
        vector(
            "magnetic_field", "T", world_.magnetic_field_W,
            "the Earth's magnetic field in world axes (x east, y north, z up), for magnetometers"),
        word(T::choice("spherical_coordinates/surface_model", {"EARTH_WGS84"},
                       "reference ellipsoid")),
        word(T::choice("spherical_coordinates/world_frame_orientation", {"ENU"},
                       "world axes: x east, y north, z up")),
        number("spherical_coordinates/latitude_deg", "deg", origin.latitude, {-90, 90},
               "latitude of the world's origin, positive north, for RotorS' GPS receiver"),
        number("spherical_coordinates/longitude_deg", "deg", origin.longitude, {-180, 180},
               "longitude of the world's origin, positive east, for RotorS' GPS receiver"),
        number("spherical_coordinates/elevation", "m", origin.altitude, {-1e5, 1e7},
               "altitude of the world's origin"),
        number("spherical_coordinates/heading_deg", "deg", origin.heading, {-360, 360},
               "rotation of the world's axes; RotorS' GPS receiver accepts only 0"),
        other("include", "", [this](const Element& e) { read_include(e); }),
        other("include/uri",
              "`model://ground_plane`: solid ground at z = 0; `model://sun`: ignored; any other is "
              "an error",
              ignored),
        other("plugin", "a module that only senses or publishes, see below; any other is an error",
              [this](const Element& e) { read_plugin(e); }),
        other("model", "an inline ground plane: static, one link; any other model is an error",
              [this](const Element& e) { read_model(e); }),
        other("model/static", "must be `true`",
              [this](const Element& e) {
                if (xml_.text(e) == "true" || xml_.text(e) == "1") return;
                xml_.fail(e, "only a static model is supported. Write true.");
              }),
        other("model/link/collision/geometry/plane/normal", "must be `0 0 1`",
              [this](const Element& e) {
                if (xml_.vector_in_text(e).isApprox(Vector3d::UnitZ())) return;
                xml_.fail(e, "only a level plane is supported. Write 0 0 1.");
              }),
        other("model/link/collision/geometry/plane/size", "ignored: the ground is infinite",
              ignored),
        other("model/link/visual", "ignored", ignored),
        other("physics", "attribute `type`, if given, must be `ode`; also written `physics:ode`",
              physics),
        other("physics:ode", "", physics),
        vector("physics/gravity", "m/s^2", world_.gravity_W,
               "the same as `gravity`; give only one of them"),
        vector("physics/magnetic_field", "T", world_.magnetic_field_W,
               "the same as `magnetic_field`; give only one of them"),
        number("physics/max_step_size", "s", world_.max_step_size, {shortest_step},
               "time step, unless `--dt` or `dt=` sets it"),
        number("physics/real_time_update_rate", "1/s", world_.real_time_update_rate, {0},
               "steps per second of wall-clock time for ROS nodes; 0: as fast as possible"),
        number("physics/updateRate", "1/s", world_.real_time_update_rate, {0},
               "the thesis' name for `real_time_update_rate`"),
        number("physics/real_time_factor", "", real_time_factor_, above(0),
               "no effect, as in Gazebo; use `real_time_update_rate`"),
        solver,
        iterations,
        number("physics/ode/solver/sor", "", world_.solver_sor, above(0, 2),
               "over-relaxation of the quick solver"),
        other("physics/ode/solver/use_dynamic_moi_rescaling", "must be `0`",
              [this](const Element& e) {
                if (xml_.text(e) == "0" || xml_.text(e) == "false") return;
                xml_.fail(e, "<use_dynamic_moi_rescaling> is '" + xml_.text(e) +
                                 "', but the engines do not rescale moments of inertia. Write 0.");
              }),
        number("physics/ode/constraints/erp", "", world_.erp, {0, 1},
               "fraction of a hinge's error that a step removes"),
        number("physics/ode/constraints/cfm", "", world_.cfm, {0}, "softness of the hinges"),
        number("physics/ode/constraints/contact_max_correcting_vel", "m/s",
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

  /// Reject an attribute `type` other than the supported one.
  void only_type(const Element& e, const std::string& supported) {
    const char* type = e.Attribute("type");
    if (!type || type == supported) return;
    xml_.fail(
        e, std::string(e.Name()) + " type '" + type + "' is not supported. Use " + supported + ".");
  }

  void read_physics(const Element& physics) {
    const Element& world = *physics.Parent()->ToElement();
    refuse_both(xml_.child(world, "physics"), xml_.child(world, "physics:ode"));
    for (const char* const name : {"gravity", "magnetic_field"}) {
      refuse_both(xml_.child(world, name), xml_.child(physics, name));
    }
    refuse_both(xml_.child(physics, "real_time_update_rate"), xml_.child(physics, "updateRate"));
    only_type(physics, "ode");
    read_children(physics, "physics/");
  }

  void read_atmosphere(const Element& atmosphere) {
    only_type(atmosphere, "adiabatic");
    read_children(atmosphere, "atmosphere/");
  }

  void read_include(const Element& include) {
    const Element* source = xml_.child(include, "uri");
    const std::string uri = source ? xml_.text(*source) : "";
    if (source && uri != "model://ground_plane" && uri != "model://sun") {
      if (xml_.ignored_elements().ignores({uri})) return;
      xml_.fail(*source,
                "'" + uri +
                    "' is not supported. Include only model://ground_plane or model://sun." +
                    suggest_ignoring(uri));
    }
    read_children(include, "include/");
    if (uri == "model://ground_plane") world_.ground_plane = true;  // model://sun is only a light
  }

  void read_plugin(const Element& plugin) {
    const std::string name = xml_.attribute(plugin, "name");
    const std::string filename = xml_.attribute(plugin, "filename");
    if (xml_.ignored_elements().ignores({name, filename})) return;
    if (decide_on_module(filename) == Handling::skip) {
      return xml_.ignored_elements().add_harmless(filename, xml_.where(plugin));
    }
    xml_.fail(plugin, "plugin '" + name + "': " + filename +
                          " is a world plugin of Gazebo, which quadcore does not load. Remove it." +
                          suggest_ignoring(filename));
  }

  /// An inline model must be a ground plane, but the user may ignore a named one.
  void read_model(const Element& model) {
    const char* name = model.Attribute("name");
    if (!name) return read_ground_plane(model);
    if (xml_.ignored_elements().ignores({name})) return;
    try {
      read_ground_plane(model);
    } catch (const InputError& error) {
      throw InputError(error.what() + suggest_ignoring(name));
    }
  }

  /// A ground plane is static and level and passes through the origin.
  void read_ground_plane(const Element& model) {
    read_children(model, "model/");
    world_.ground_plane = true;
  }

  World world_;
  double real_time_factor_ = 1;
  Xml xml_;
  std::vector<Row> rows_ = table();
};

}  // namespace

World read_world(const Document& document, const std::vector<std::string>& ignore) {
  World world = WorldReader(document, ignore).read();
  world.source = std::make_shared<Source>(Source{document, ignore});
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
