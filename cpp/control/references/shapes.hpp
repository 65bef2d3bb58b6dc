#pragma once

#include <utility>

#include "references/yaw_motion.hpp"

namespace quadcore::control {

/// Describe a kind of reference of class Shape, whose members are its settings.
template <class Shape>
ReferenceInfo shape(const std::string& name, const std::string& summary, Settings<Shape> settings,
                    const Values& defaults = {}) {
  return {name, summary, false, with_defaults(table_of(settings), defaults),
          [settings = std::move(settings), defaults](const Values& values, const Rows&) {
            auto made = std::make_unique<Shape>();
            configure(*made, settings, complete(values, defaults));
            return made;
          }};
}

ReferenceInfo hover();
ReferenceInfo step();
ReferenceInfo ramp();
ReferenceInfo spiral();
ReferenceInfo circle();
ReferenceInfo eight();
ReferenceInfo waypoints();
ReferenceInfo series();
ReferenceInfo takeoff_land();

}  // namespace quadcore::control
