#include "shortest_rotation.hpp"

namespace quadcore {

Quaterniond shortest_rotation(const Vector3d& from, const Vector3d& to) {
  return Quaterniond::FromTwoVectors(from, to);
}

}  // namespace quadcore
