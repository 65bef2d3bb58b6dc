#pragma once

#include <map>
#include <string>

#include "sdf_pose.hpp"
#include "xml.hpp"

namespace quadcore {

/// The frames of a model or of the world. From SDF 1.7 on, a `<pose relative_to="FRAME">` is
/// relative to a `<frame>`, a link or a model beside it; older versions ignore such attributes.
class SdfFrames {
 public:
  /// \param owner  the `<model>` or `<world>`; its own frame is `__model__` or `world`
  SdfFrames(const Xml& xml, const Xml::Element& owner, bool has_frames);

  /// Return the pose of a child of the owner, or of an element inside such a child, whose poses are
  /// relative to the owner unless `relative_to` names another frame.
  Placement find_pose(const Xml::Element& element) const;
  /// Return the pose of a frame to which an element refers by name.
  Placement find_frame(const Xml::Element& element, const std::string& name) const;

 private:
  Placement find_pose(const Xml::Element& element, int depth) const;
  Placement find_frame(const Xml::Element& element, const std::string& name, int depth) const;

  const Xml& xml_;
  bool has_frames_;
  std::map<std::string, const Xml::Element*> frames_;
};

}  // namespace quadcore
