#pragma once

#include <string>
#include <vector>

namespace quadcore {

/// Finds the models that a world includes, in Gazebo's order: the folders of GAZEBO_MODEL_PATH,
/// ~/.gazebo/models, and the folders that the packages of ROS_PACKAGE_PATH export with
/// `<gazebo_ros gazebo_model_path="..."/>`.
class ModelPath {
 public:
  ModelPath();

  /// Return the SDF file of `model://NAME`, `package://NAME/FOLDER` or `file://PATH`, or "" if
  /// there is none. A folder's model.config names the file for each version of SDF; the newest
  /// version up to 1.7 counts, which is Gazebo 11's.
  std::string find(const std::string& uri);
  /// Return the file of `model://NAME/FILE`, `package://NAME/FILE` or `file://PATH`, or "".
  std::string find_file(const std::string& uri);

 private:
  struct Package {
    std::string name, folder;
    std::vector<std::string> model_folders;
  };
  const std::vector<Package>& packages();
  template <class Find>
  std::string find_by(const std::string& uri, const Find& find);

  std::vector<std::string> folders_;
  std::vector<Package> packages_;
  bool has_packages_ = false;
};

}  // namespace quadcore
