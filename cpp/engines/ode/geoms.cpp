#include "geoms.hpp"

#include "quadcore/plugin/error.hpp"

namespace quadcore {
namespace {

/// Return the geom of a box, cylinder or sphere, or null.
dGeomID create_geom(ShapeKind kind, const Vector3d& size) {
  switch (kind) {
    case ShapeKind::box:
      return dCreateBox(nullptr, size.x(), size.y(), size.z());
    case ShapeKind::cylinder:
      return dCreateCylinder(nullptr, size.x(), size.y());
    case ShapeKind::sphere:
      return dCreateSphere(nullptr, size.x());
    default:
      return nullptr;
  }
}

/// Return the geom of triangles, which must outlive it. Its contacts with a
/// sphere are left as they are; see merge_of_sphere().
dGeomID create_mesh(const TriangleMesh& mesh) {
  const dTriMeshDataID data = dGeomTriMeshDataCreate();
  dGeomTriMeshDataBuildSingle(
      data, mesh.vertices.data(), sizeof mesh.vertices[0], static_cast<int>(mesh.vertices.size()),
      mesh.triangles.data(), static_cast<int>(3 * mesh.triangles.size()), sizeof mesh.triangles[0]);
  const dGeomID geom = dCreateTriMesh(nullptr, data, nullptr, nullptr, nullptr);
  int merged = dGeomColliderMergeContactsValue_None, size = sizeof merged;
  dGeomLowLevelControl(geom, dGeomColliderControlClass,
                       dGeomColliderSetMergeSphereContactsControlCode, &merged, &size);
  return geom;
}

}  // namespace

void DestroyGeom::operator()(dxGeom* geom) const {
  const dTriMeshDataID data =
      dGeomGetClass(geom) == dTriMeshClass ? dGeomTriMeshGetData(geom) : nullptr;
  dGeomDestroy(geom);
  if (data) dGeomTriMeshDataDestroy(data);
}

Geom create_shape(const Collision& collision) {
  if (const dGeomID geom = create_geom(collision.kind, collision.size)) return Geom(geom);
  throw InputError(collision.where +
                   ": contact of a collision mesh with the ground is not modelled. Use a box, "
                   "cylinder or sphere, or a world without ground.");
}

Geom create_solid(const Obstacle& obstacle) {
  const Vector3d &size = obstacle.size, &p = obstacle.position_W;
  if (obstacle.kind == ShapeKind::plane) {
    return Geom(dCreatePlane(nullptr, size.x(), size.y(), size.z(), p.z()));
  }
  const dGeomID geom = obstacle.kind == ShapeKind::mesh ? create_mesh(*obstacle.mesh)
                                                        : create_geom(obstacle.kind, size);
  const Quaterniond& q = obstacle.orientation_W;
  const dQuaternion ode_q = {q.w(), q.x(), q.y(), q.z()};
  dGeomSetPosition(geom, p.x(), p.y(), p.z());
  dGeomSetQuaternion(geom, ode_q);
  return Geom(geom);
}

}  // namespace quadcore
