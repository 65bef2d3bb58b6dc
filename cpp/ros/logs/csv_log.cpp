#include "csv_log.hpp"

#include <utility>

#include "quadcore/log.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore::node {

CsvLog::CsvLog(const std::string& path, const Simulation& simulation, LogRow row)
    : path_(path), row_(std::move(row)), file_(std::fopen(path.c_str(), "w")) {
  if (!file_) throw InputError(describe_open_failure(path));
  const std::string header = row_.header() + log_remark(simulation.ignored()) + "\n";
  std::fputs(header.c_str(), file_.get());
}

void CsvLog::add(const Simulation& simulation) {
  const std::vector<double>& row = row_.fill(simulation);
  line_.clear();
  append_csv(row.data(), row.size(), line_);
  std::fwrite(line_.data(), 1, line_.size(), file_.get());
  check(std::ferror(file_.get()) == 0);
}

void CsvLog::close() {
  if (file_) check(std::fclose(file_.release()) == 0);
}

void CsvLog::check(bool written) {
  if (!written) fail(describe_truncation(path_));
}

}  // namespace quadcore::node
