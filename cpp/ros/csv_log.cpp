#include "csv_log.hpp"

#include <cerrno>
#include <cstring>

#include "quadcore/error.hpp"
#include "quadcore/log.hpp"

namespace quadcore::node {
namespace {

/// Opens a file. Throws InputError on a name of a format that needs all rows at once.
std::FILE* opened(const std::string& path) {
  for (const std::string other : {".mat", ".bag"}) {
    if (path.size() < other.size() || path.substr(path.size() - other.size()) != other) continue;
    throw InputError(path +
                     ": the node writes CSV; name a .csv file, of which `quadcore convert` " +
                     "makes a " + other + " afterwards");
  }
  return std::fopen(path.c_str(), "w");
}

}  // namespace

CsvLog::CsvLog(const std::string& path, const Simulation& simulation,
               const std::vector<std::string>& topics)
    : path_(path), topics_(simulation.topics().at(topics)), file_(opened(path)) {
  if (!file_) throw InputError(path + ": cannot be written: " + std::strerror(errno));
  std::string header;
  for (const std::string& column : log_columns(simulation.model().joints.size())) {
    header += (header.empty() ? "" : ",") + column;
  }
  for (const std::size_t topic : topics_) {
    for (const std::string& column : log_columns(simulation.topics()[topic]))
      header += "," + column;
  }
  header += log_remark(simulation.ignored());
  std::fprintf(file_.get(), "%s\n", header.c_str());
}

void CsvLog::add(const Simulation& simulation) {
  row_.clear();
  append_log_row(simulation.state(), row_);
  for (const std::size_t topic : topics_) append_log_row(simulation.topics()[topic], row_);
  line_.clear();
  append_csv(row_.data(), row_.size(), line_);
  std::fwrite(line_.data(), 1, line_.size(), file_.get());
  check(std::ferror(file_.get()) == 0);
}

void CsvLog::close() {
  if (file_) check(std::fclose(file_.release()) == 0);
}

void CsvLog::check(bool written) {
  if (written || !error_.empty()) return;
  error_ = path_ + ": the log is cut short: " + std::strerror(errno);
}

}  // namespace quadcore::node
