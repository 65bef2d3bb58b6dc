#include "saved_state.hpp"

#include <cstring>
#include <type_traits>

#include "quadcore/plugin/error.hpp"

namespace quadcore::fmu {
namespace {

/// Writes values consecutively. Each f(archive, x) below visits the members of x for both writer
/// and reader, so that they agree.
class Writer {
 public:
  static constexpr bool reads = false;
  std::string bytes;

  void raw(void* data, std::size_t size) { bytes.append(static_cast<const char*>(data), size); }
};

class Reader {
 public:
  static constexpr bool reads = true;

  explicit Reader(const std::string& bytes) : bytes_(bytes) {}
  void raw(void* data, std::size_t size) {
    if (size > left()) throw InputError("the saved state is damaged. Save it again.");
    std::memcpy(data, bytes_.data() + at_, size);
    at_ += size;
  }
  std::size_t left() const { return bytes_.size() - at_; }

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
};

template <class Archive, class T,
          std::enable_if_t<std::is_arithmetic_v<T> && !std::is_same_v<T, bool>, int> = 0>
void visit(Archive& archive, T& number) {
  archive.raw(&number, sizeof number);
}

/// Read a boolean, which must be 0 or 1.
template <class Archive>
void visit(Archive& archive, bool& flag) {
  unsigned char byte = flag ? 1 : 0;
  visit(archive, byte);
  if (byte > 1) throw InputError("the saved state is damaged. Save it again.");
  flag = byte == 1;
}

/// Resize a row to the length that is read.
template <class Archive, class Row>
void visit_length(Archive& archive, Row& row) {
  auto length = static_cast<std::uint64_t>(row.size());
  visit(archive, length);
  if constexpr (Archive::reads) {
    if (length > archive.left()) throw InputError("the saved state is damaged. Save it again.");
    row.resize(static_cast<std::size_t>(length));
  }
}

template <class Archive>
void visit(Archive& archive, std::string& text) {
  visit_length(archive, text);
  archive.raw(text.data(), text.size());
}

template <class Archive>
void visit(Archive& archive, VectorXd& numbers) {
  visit_length(archive, numbers);
  archive.raw(numbers.data(), static_cast<std::size_t>(numbers.size()) * sizeof(double));
}

template <class Archive, class T>
void visit(Archive& archive, std::vector<T>& row) {
  visit_length(archive, row);
  for (T& item : row) visit(archive, item);
}

template <class Archive>
void visit(Archive& archive, Message& message) {
  visit(archive, message.values);
  visit(archive, message.stamp);
  visit(archive, message.count);
}

template <class Archive>
void visit(Archive& archive, Fact& fact) {
  visit(archive, fact.what);
  visit(archive, fact.numbers);
  visit(archive, fact.text);
}

template <class Archive>
void visit(Archive& archive, Snapshot& snapshot) {
  Fingerprint fingerprint = snapshot.taken_from ? *snapshot.taken_from : Fingerprint();
  for (const FingerprintPart& part : fingerprint_parts()) visit(archive, fingerprint.*part.facts);
  if constexpr (Archive::reads) {
    snapshot.taken_from = std::make_shared<Fingerprint>(fingerprint);
  }
  visit(archive, snapshot.start_time);
  visit(archive, snapshot.steps);
  visit(archive, snapshot.seed);
  visit(archive, snapshot.engine);
  visit(archive, snapshot.plugin_state);
  visit(archive, snapshot.messages);
  visit(archive, snapshot.warnings);
  visit(archive, snapshot.failure);
}

/// The keys come from the file.
template <class Archive>
void visit(Archive& archive, Settings& settings) {
  visit(archive, settings.seed);
  archive.raw(settings.spawn.xyz.data(), 3 * sizeof(double));
  archive.raw(settings.spawn.rpy.data(), 3 * sizeof(double));
  for (auto& [tag, value] : settings.tags) visit(archive, value);
  for (auto& [topic, message] : settings.inputs) {
    for (double& value : message.values) visit(archive, value);
    visit(archive, message.is_set);
  }
}

template <class Archive>
void visit(Archive& archive, SavedState& state) {
  visit(archive, state.settings);
  visit(archive, state.start_time);
  bool is_made = state.snapshot != nullptr;
  visit(archive, is_made);
  if (!is_made) return;
  Snapshot snapshot = state.snapshot ? *state.snapshot : Snapshot();
  visit(archive, snapshot);
  if constexpr (Archive::reads) state.snapshot = std::make_shared<Snapshot>(std::move(snapshot));
  visit(archive, state.is_flying);
}

}  // namespace

std::string serialised(const SavedState& state) {
  Writer writer;
  SavedState copy = state;
  visit(writer, copy.guid);
  visit(writer, copy);
  return writer.bytes;
}

SavedState deserialised(const FlightFile& file, const std::string& bytes) {
  Reader reader(bytes);
  SavedState state{"", Settings(file), 0, nullptr, false};
  visit(reader, state.guid);
  if (state.guid != file.guid)
    throw InputError("the saved state belongs to another FMU. Save it again with this one.");
  visit(reader, state);
  if (reader.left() != 0) throw InputError("the saved state is damaged. Save it again.");
  return state;
}

}  // namespace quadcore::fmu
