#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <cstdint>
#include <string>
#include <vector>

#include "file.hpp"

/// \file
/// Bags of ROS 1 (wiki.ros.org/Bags/Format/2.0), not compressed. The library of rosbag brings
/// plugins for encryption along, whose headers Debian 12 has for ROS 2 alone.

namespace quadcore::node {

/// A bag that grows by whole chunks. One that is not closed is one for `rosbag reindex`.
class BagFile {
 public:
  /// Makes a file; is_open() tells whether it could.
  explicit BagFile(const std::string& path);
  bool is_open() const { return file_ != nullptr; }
  /// A topic for messages of a type. Returns its number.
  template <class Message>
  std::uint32_t add(const std::string& topic) {
    namespace traits = ros::message_traits;
    return add(topic, traits::datatype<Message>(), traits::md5sum<Message>(),
               traits::definition<Message>());
  }
  template <class Message>
  void write(std::uint32_t topic, const ros::Time& time, const Message& message) {
    bytes_.resize(ros::serialization::serializationLength(message));
    ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(&bytes_[0]),
                                       static_cast<std::uint32_t>(bytes_.size()));
    ros::serialization::serialize(stream, message);
    write_bytes(topic, time);
  }
  /// Writes what waits, and the index. What has failed is cut off before.
  void close();
  /// Whether all was written so far; errno has the reason.
  bool is_whole() const { return is_whole_; }
  /// Whether what is there has its index.
  bool is_indexed() const { return is_indexed_; }

 private:
  /// Where a message lies.
  struct Entry {
    ros::Time time;
    std::uint32_t offset;  ///< in its chunk
  };
  struct Chunk {
    std::uint64_t place;
    ros::Time first, last;
    std::vector<std::uint32_t> counts;  ///< messages by topic
  };

  std::uint32_t add(const std::string& topic, const char* type, const char* md5sum,
                    const char* definition);
  void write_bytes(std::uint32_t topic, const ros::Time& time);
  void write_chunk();
  /// The first record, which tells where the index begins; 0 = there is none.
  void write_head(std::uint64_t index);
  bool put(const std::string& bytes);

  File file_;
  bool is_whole_ = true, is_indexed_ = false;
  std::uint64_t end_ = 0;                    ///< of the whole chunks
  std::vector<std::string> connections_;     ///< records
  std::vector<std::vector<Entry>> entries_;  ///< of the chunk that waits, by topic
  std::vector<Chunk> chunks_;
  std::string chunk_;  ///< that waits
  std::string bytes_;  ///< of a message, kept, so that it needs no new memory
};

}  // namespace quadcore::node
