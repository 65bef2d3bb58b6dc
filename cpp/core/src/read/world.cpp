#include "quadcore/plugin/world.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "quadcore/plugin/error.hpp"
#include "quadcore/seen_or_sensed.hpp"
#include "quadcore/text.hpp"
#include "xml.hpp"

namespace quadcore {
namespace {

using Element = Xml::Element;
using Handler = std::function<void(const Element&)>;

/// An element that a world may hold: the path below <world> is its name. One without a meaning is
/// another name, or only holds elements that have one.
struct Row {
  TagSpec spec;
  Handler read;
};

/// Elements that may occur several times in one place.
const std::set<std::string> repeatable = {"include", "model", "plugin", "visual"};

/// Elements that the one around them, if it is there, needs.
constexpr const char* required[] = {"wind/linear_velocity",
                                    "include/uri",
                                    "model/static",
                                    "model/link",
                                    "model/link/collision",
                                    "model/link/collision/geometry",
                                    "model/link/collision/geometry/plane"};

/// Attributes that an element with children may have.
std::set<std::string> attributes_of(const std::string& element) {
  if (element == "sdf") return {"version"};
  if (element == "atmosphere") return {"type"};
  if (element == "physics" || element == "physics:ode") return {"name", "default", "type"};
  if (element == "world" || element == "model" || element == "link" || element == "collision") {
    return {"name"};
  }
  return {};
}

/// Reads the elements that a world may hold into a World.
class WorldReader {
 public:
  WorldReader(const Document& document, const std::vector<std::string>& ignore)
      : xml_(document, "sdf", world_.passed_over) {
    world_.passed_over = PassedOver(ignore);
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

  /// Reads the children of the element at a path, which ends with / unless it is empty.
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
    bool open = false;  ///< min itself is out of range
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
              xml_.fail(e, "<" + std::string(e.Name()) + "> is out of range; write a number " +
                               spec.interval());
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
              xml_.fail(e,
                        "<" + std::string(e.Name()) + "> is '" + text + "'; write " + alternatives);
            }};
  }

  /// An element without a value that a table could show.
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
                                "in flight both give the same answer, see [gazebo.md](gazebo.md)"));
    solver.read = [this, check = solver.read](const Element& e) {
      check(e);
      world_.solver_type = xml_.text(e);
      world_.solver_type_where = xml_.where(e);
    };
    const Row iterations = {
        T::number("physics/ode/solver/iters", "", std::to_string(world_.solver_iterations),
                  "sweeps of the quick solver, a whole number")
            .at_least(1)
            .at_most(1e6),
        [this](const Element& e) {
          const double value = xml_.number_in_text(e);
          if (!(value >= 1 && value <= 1e6) || value != std::floor(value)) {
            xml_.fail(e, "<iters> must be a whole number from 1 to 1000000");
          }
          world_.solver_iterations = static_cast<int>(value);
        }};
    return {
        vector("gravity", "m/s^2", world_.gravity_W, "gravity in world axes"),
        vector("wind/linear_velocity", "m/s", world_.wind_W,
               "velocity of the air in world axes; `chapter2` only"),
        other("atmosphere",
              "attribute `type`, if given, must be `adiabatic`; felt where a plugin's tag says so",
              [this](const Element& e) { read_atmosphere(e); }),
        number("atmosphere/temperature", "K", air.temperature, above(0), "of the air at z = 0"),
        number("atmosphere/temperature_gradient", "K/m", air.temperature_gradient, {},
               "its change with height"),
        number("atmosphere/pressure", "Pa", air.pressure, {0}, "of the air at z = 0"),
        vector("magnetic_field", "T", world_.magnetic_field_W,
               "of the Earth in world axes, x east, y north, z up; for magnetometers"),
        word(T::choice("spherical_coordinates/surface_model", {"EARTH_WGS84"}, "ellipsoid")),
        word(T::choice("spherical_coordinates/world_frame_orientation", {"ENU"},
                       "x east, y north, z up")),
        number("spherical_coordinates/latitude_deg", "deg", origin.latitude, {-90, 90},
               "of the world's origin, positive north; for RotorS' satellite receiver"),
        number("spherical_coordinates/longitude_deg", "deg", origin.longitude, {-180, 180},
               "the same, positive east"),
        number("spherical_coordinates/elevation", "m", origin.altitude, {-1e5, 1e7}, "its height"),
        number("spherical_coordinates/heading_deg", "deg", origin.heading, {-360, 360},
               "by which the axes are turned; a satellite receiver takes 0 alone"),
        other("include", "", [this](const Element& e) { read_include(e); }),
        other("include/uri",
              "`model://ground_plane`: solid ground at z = 0; `model://sun`: ignored; another is "
              "foreign",
              ignored),
        other("plugin", "a module that only senses or publishes, see below; another is foreign",
              [this](const Element& e) { read_plugin(e); }),
        other("model", "a ground plane in line: static, one link; another is foreign",
              [this](const Element& e) { read_model(e); }),
        other("model/static", "must be `true`",
              [this](const Element& e) {
                if (xml_.text(e) == "true" || xml_.text(e) == "1") return;
                xml_.fail(e, "only a static model is supported; write true");
              }),
        other("model/link/collision/geometry/plane/normal", "must be `0 0 1`",
              [this](const Element& e) {
                if (xml_.vector_in_text(e).isApprox(Vector3d::UnitZ())) return;
                xml_.fail(e, "only a level plane is supported; write 0 0 1");
              }),
        other("model/link/collision/geometry/plane/size", "ignored: the ground has no edge",
              ignored),
        other("model/link/visual", "ignored", ignored),
        other("physics", "attribute `type`, if given, must be `ode`; also written `physics:ode`",
              physics),
        other("physics:ode", "", physics),
        vector("physics/gravity", "m/s^2", world_.gravity_W,
               "the same as `gravity`; only one of them"),
        vector("physics/magnetic_field", "T", world_.magnetic_field_W,
               "the same as `magnetic_field`; only one of them"),
        number("physics/max_step_size", "s", world_.max_step_size, {shortest_step},
               "the step, unless `--dt` or `dt=` is given"),
        number("physics/real_time_update_rate", "1/s", world_.real_time_update_rate, {0},
               "steps per second of wall clock, 0 = as fast as possible; for nodes that pace"),
        number("physics/updateRate", "1/s", world_.real_time_update_rate, {0},
               "the thesis' name of `real_time_update_rate`"),
        number("physics/real_time_factor", "", real_time_factor_, above(0),
               "without effect, as in Gazebo; `real_time_update_rate` sets the pace"),
        solver,
        iterations,
        number("physics/ode/solver/sor", "", world_.solver_sor, above(0, 2), "its over-relaxation"),
        other("physics/ode/solver/use_dynamic_moi_rescaling", "must be `0`",
              [this](const Element& e) {
                if (xml_.text(e) == "0" || xml_.text(e) == "false") return;
                xml_.fail(e, "<use_dynamic_moi_rescaling> is '" + xml_.text(e) +
                                 "'; the engines rescale no moments of inertia, write 0");
              }),
        number("physics/ode/constraints/erp", "", world_.erp, {0, 1},
               "part of a hinge's error that a step removes"),
        number("physics/ode/constraints/cfm", "", world_.cfm, {0}, "softness of the hinges"),
        number("physics/ode/constraints/contact_max_correcting_vel", "m/s",
               world_.contact_max_correcting_vel, {0},
               "caps what a correction leaves of velocity: a contact's `maxVel`, in `gazebo11` "
               "also a hinge's, see [gazebo.md](gazebo.md#random-vehicles)"),
    };
  }

  /// Of two places for one value, giving both would leave open which counts.
  void refuse_both(const Element* first, const Element* second) {
    if (!first || !second) return;
    xml_.fail(*second, "<" + std::string(second->Name()) + "> beside <" + first->Name() + "> (" +
                           xml_.where(*first) + "); keep one of them");
  }

  /// Refuses an attribute `type` other than the one that is modelled.
  void only_type(const Element& e, const std::string& supported) {
    const char* type = e.Attribute("type");
    if (!type || type == supported) return;
    xml_.fail(e,
              std::string(e.Name()) + " type '" + type + "' is not supported; write " + supported);
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
      if (xml_.passed_over().ignores({uri})) return;
      xml_.fail(*source, "'" + uri +
                             "' is not supported; a world may include model://ground_plane and "
                             "model://sun" +
                             ignoring(uri));
    }
    read_children(include, "include/");
    if (uri == "model://ground_plane") world_.ground_plane = true;  // the sun: no light here
  }

  void read_plugin(const Element& plugin) {
    const std::string name = xml_.attribute(plugin, "name");
    const std::string filename = xml_.attribute(plugin, "filename");
    if (xml_.passed_over().ignores({name, filename})) return;
    if (verdict_on_module(filename) == Verdict::unfelt) {
      return xml_.passed_over().add_unfelt(filename, xml_.where(plugin));
    }
    xml_.fail(plugin, "plugin '" + name + "': " + filename +
                          " is a module of Gazebo's worlds, which are not loaded here; remove it" +
                          ignoring(filename));
  }

  /// A model in line may only be a ground plane; another may be left out.
  void read_model(const Element& model) {
    const char* name = model.Attribute("name");
    if (!name) return read_ground_plane(model);
    if (xml_.passed_over().ignores({name})) return;
    try {
      read_ground_plane(model);
    } catch (const InputError& error) {
      throw InputError(error.what() + ignoring(name));
    }
  }

  /// Static, a plane through the origin, normal up.
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
