#include "mat_log.hpp"

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <utility>

#include "mat_file.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore::node {
namespace {

/// Resolves a link, because its target is replaced.
std::string resolve_link(const std::string& path) {
  std::error_code error;
  const std::filesystem::path found = std::filesystem::weakly_canonical(path, error);
  return error ? path : found.string();
}

/// Returns the path of a temporary file in the same folder, because renaming is atomic within a
/// file system.
std::string make_part_path(const std::string& path) {
  const std::filesystem::path whole(path);
  return whole.parent_path() / ("." + whole.filename().string() + ".part");
}

/// Opens a file without a name in the same folder.
std::FILE* open_unnamed_file(const std::string& path) {
  std::string name = make_part_path(path) + ".XXXXXX";
  const int descriptor = mkstemp(name.data());
  if (descriptor < 0) return nullptr;
  unlink(name.c_str());
  return fdopen(descriptor, "w+");
}

}  // namespace

MatLog::MatLog(const std::string& path, const Simulation& simulation, LogRow row)
    : path_(resolve_link(path)),
      part_(make_part_path(path_)),
      ignored_(simulation.ignored()),
      row_(std::move(row)),
      rows_(open_unnamed_file(path_)) {
  const bool is_there = access(path_.c_str(), F_OK) == 0;
  if (!rows_ || (is_there && access(path_.c_str(), W_OK) != 0))
    throw InputError(describe_open_failure(path_));
}

void MatLog::add(const Simulation& simulation) {
  const std::vector<double>& row = row_.fill(simulation);
  if (!error().empty()) return;  // an incomplete row would shift all others
  std::fwrite(row.data(), sizeof(double), row.size(), rows_.get());
  if (std::ferror(rows_.get()) != 0) fail(describe_truncation(path_));
}

void MatLog::close() {
  const int descriptor = fileno(rows_.get());
  if (std::fflush(rows_.get()) != 0) fail(describe_truncation(path_));
  struct stat now{};
  fstat(descriptor, &now);
  const std::size_t size = static_cast<std::size_t>(now.st_size);
  const std::size_t count = size / (sizeof(double) * row_.columns().size());
  if (count == 0) return;
  void* const rows = mmap(nullptr, size, PROT_READ, MAP_SHARED, descriptor, 0);
  if (rows == MAP_FAILED) return fail(describe_open_failure(path_));
  try {
    write(static_cast<const double*>(rows), count);
  } catch (const std::exception& error) {
    unlink(part_.c_str());
    fail(error.what());
  }
  munmap(rows, size);
}

void MatLog::write(const double* rows, std::size_t count) const {
  File file(std::fopen(part_.c_str(), "w"));
  if (!file) throw InputError(describe_open_failure(path_));
  MatFile mat(file.get());
  std::vector<MatVector> fields;  // fields of one topic
  const std::vector<std::string>& names = row_.columns();
  const auto topic_of = [](const std::string& name) { return name.substr(0, name.find('.')); };
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto at = [first = rows + i, width = names.size()](std::size_t row) {
      return first[row * width];
    };
    const std::string topic = topic_of(names[i]);
    if (topic == names[i]) {
      mat.write_vector({names[i], at}, count);
      continue;
    }
    fields.push_back({names[i].substr(topic.size() + 1), at});
    if (i + 1 < names.size() && topic_of(names[i + 1]) == topic) continue;
    mat.write_structure("topic_" + topic, std::exchange(fields, {}), count);
  }
  if (!ignored_.empty()) mat.write_texts("ignored", ignored_);
  const bool written = std::ferror(file.get()) == 0;
  if (std::fclose(file.release()) != 0 || !written ||
      std::rename(part_.c_str(), path_.c_str()) != 0) {
    throw InputError(describe_open_failure(path_));
  }
}

}  // namespace quadcore::node
