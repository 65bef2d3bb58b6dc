#pragma once

#include <optional>
#include <string>
#include <vector>

#include "quadcore/plugin/free_body.hpp"
#include "sdf_frames.hpp"
#include "sdf_pose.hpp"
#include "xml.hpp"

namespace quadcore {

/// Read what a link that is not static moves by: inertia, gravity, decay of its velocity. Throws
/// InputError with FILE:LINE for an inertia that no body has.
FreeBody read_free_body(const Xml& xml, const Xml::Element& link);

/// A link of a model to which a joint may refer.
struct JointedLink {
  std::string name;  ///< as a joint names it: LINK, or NESTED::LINK
  std::size_t body;  ///< index among the free bodies
  Placement X_ML;    ///< in the model, without a saved state
};

/// Read a joint between free links.
/// \param frames  those of its model
/// Throws InputError with FILE:LINE for a joint that is not supported.
FreeJoint read_free_joint(const Xml& xml, const Xml::Element& joint,
                          const std::vector<JointedLink>& links, const SdfFrames& frames,
                          const Placement& X_WM);

}  // namespace quadcore
