#include "bag_file.hpp"

#include <roslz4/lz4s.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace quadcore::node {
namespace {

// Kinds of records in the format.
constexpr char message_data = 2, bag_header = 3, index_data = 4, chunk = 5, chunk_info = 6,
               connection = 7;
constexpr std::size_t head_size = 4096;  ///< size of the first record, without its two lengths
constexpr std::size_t chunk_size = 768 * 1024;  ///< like rosbag

template <class Number>
std::string to_bytes(Number number) {
  std::string bytes(sizeof number, '\0');
  std::memcpy(&bytes[0], &number, sizeof number);
  return bytes;
}

std::string to_bytes(const ros::Time& time) { return to_bytes(time.sec) + to_bytes(time.nsec); }

std::string with_size(const std::string& bytes) {
  return to_bytes(static_cast<std::uint32_t>(bytes.size())) + bytes;
}

std::string make_field(const char* name, const std::string& value) {
  return with_size(name + ("=" + value));
}

std::string compress(std::string bytes) {
  // LZ4 adds at most 1/255 and some bytes per block.
  std::string packed(bytes.size() + bytes.size() / 200 + 1024, '\0');
  auto size = static_cast<unsigned int>(packed.size());
  constexpr int block_size = 6;  // like rosbag: 1 MiB
  const int status = roslz4_buffToBuffCompress(&bytes[0], static_cast<unsigned int>(bytes.size()),
                                               &packed[0], &size, block_size);
  if (status != ROSLZ4_OK) throw std::runtime_error("roslz4 cannot compress a part of the bag");
  packed.resize(size);
  return packed;
}

std::string make_kind(char number) { return make_field("op", std::string(1, number)); }

}  // namespace

BagFile::BagFile(const std::string& path) : file_(std::fopen(path.c_str(), "w")) {
  if (!file_) return;
  put("#ROSBAG V2.0\n");
  write_head(0);
  end_ = static_cast<std::uint64_t>(std::ftell(file_.get()));
}

std::uint32_t BagFile::add(const std::string& topic, const char* type, const char* md5sum,
                           const char* definition) {
  const auto number = static_cast<std::uint32_t>(connections_.size());
  connections_.push_back(with_size(make_field("conn", to_bytes(number)) + make_kind(connection) +
                                   make_field("topic", topic)) +
                         with_size(make_field("topic", topic) + make_field("type", type) +
                                   make_field("md5sum", md5sum) +
                                   make_field("message_definition", definition)));
  entries_.emplace_back();
  return number;
}

void BagFile::write_bytes(std::uint32_t topic, const ros::Time& time) {
  if (!is_whole_) return;
  // Each chunk can be read without the others.
  if (entries_[topic].empty()) chunk_ += connections_[topic];
  entries_[topic].push_back({time, static_cast<std::uint32_t>(chunk_.size())});
  chunk_ += with_size(make_field("conn", to_bytes(topic)) + make_kind(message_data) +
                      make_field("time", to_bytes(time)));
  chunk_ += with_size(bytes_);
  if (chunk_.size() >= chunk_size) write_chunk();
}

void BagFile::write_chunk() {
  Chunk written{end_, ros::TIME_MAX, ros::TIME_MIN, {}};
  std::string index;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    std::vector<Entry>& entries = entries_[i];
    // A reset sets the time back.
    std::stable_sort(entries.begin(), entries.end(),
                     [](const Entry& a, const Entry& b) { return a.time < b.time; });
    written.counts.push_back(static_cast<std::uint32_t>(entries.size()));
    if (entries.empty()) continue;
    written.first = std::min(written.first, entries.front().time);
    written.last = std::max(written.last, entries.back().time);
    index += with_size(make_field("conn", to_bytes(static_cast<std::uint32_t>(i))) +
                       make_field("count", to_bytes(written.counts.back())) +
                       make_kind(index_data) + make_field("ver", to_bytes(std::uint32_t{1})));
    std::string places;
    for (const Entry& entry : entries) places += to_bytes(entry.time) + to_bytes(entry.offset);
    index += with_size(places);
    entries.clear();
  }
  const std::string head = make_field("compression", "lz4") + make_kind(chunk) +
                           make_field("size", to_bytes(static_cast<std::uint32_t>(chunk_.size())));
  is_whole_ = put(with_size(head)) && put(with_size(compress(chunk_))) && put(index) &&
              std::fflush(file_.get()) == 0;
  chunk_.clear();
  if (!is_whole_) return;
  chunks_.push_back(std::move(written));
  end_ = static_cast<std::uint64_t>(std::ftell(file_.get()));
}

void BagFile::close() {
  if (is_whole_ && !chunk_.empty()) write_chunk();
  std::clearerr(file_.get());
  std::FILE* const file = file_.get();
  bool good = is_whole_ || ftruncate(fileno(file), static_cast<off_t>(end_)) == 0;
  good = good && std::fseek(file, static_cast<long>(end_), SEEK_SET) == 0;
  std::string index;
  for (const std::string& record : connections_) index += record;
  for (const Chunk& written : chunks_) {
    std::string counts;
    std::uint32_t topics = 0;
    for (std::size_t i = 0; i < written.counts.size(); ++i) {
      if (written.counts[i] == 0) continue;
      ++topics;
      counts += to_bytes(static_cast<std::uint32_t>(i)) + to_bytes(written.counts[i]);
    }
    index += with_size(make_field("chunk_pos", to_bytes(written.place)) +
                       make_field("count", to_bytes(topics)) +
                       make_field("end_time", to_bytes(written.last)) + make_kind(chunk_info) +
                       make_field("start_time", to_bytes(written.first)) +
                       make_field("ver", to_bytes(std::uint32_t{1})));
    index += with_size(counts);
  }
  good = good && put(index) && std::fflush(file) == 0 &&
         std::fseek(file, static_cast<long>(std::strlen("#ROSBAG V2.0\n")), SEEK_SET) == 0;
  if (good) write_head(end_);
  const bool closed = std::fclose(file_.release()) == 0;
  is_indexed_ = good && closed;
  is_whole_ = is_whole_ && is_indexed_;
}

void BagFile::write_head(std::uint64_t index) {
  const std::string head =
      make_field("chunk_count", to_bytes(static_cast<std::uint32_t>(chunks_.size()))) +
      make_field("conn_count",
                 to_bytes(static_cast<std::uint32_t>(index == 0 ? 0 : connections_.size()))) +
      make_field("index_pos", to_bytes(index)) + make_kind(bag_header);
  put(with_size(head) + with_size(std::string(head_size - head.size(), ' ')));
}

bool BagFile::put(const std::string& bytes) {
  return std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) == bytes.size();
}

}  // namespace quadcore::node
