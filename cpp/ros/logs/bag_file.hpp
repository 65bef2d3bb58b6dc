#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <cstdint>
#include <string>
#include <vector>

#include "file.hpp"

/// \file
/// Bags of ROS 1 with chunks compressed by LZ4 (wiki.ros.org/Bags/Format/2.0). The header of
/// rosbag_storage includes pluginlib for encryption, which Debian 12 packages for ROS 2 only.

namespace quadcore::node {

/// A bag that grows by whole chunks. If it was not closed, `rosbag reindex` repairs it.
class BagFile {
 public:
  /// Creates a file; is_open() returns whether this succeeded.
  explicit BagFile(const std::string& path);
  bool is_open() const { return file_ != nullptr; }
  /// Adds a topic for messages of a type. Returns its number.
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
  /// Writes waiting messages and the index. Removes an incomplete chunk first.
  void close();
  /// Whether everything was written so far; errno has the reason of a failure.
  bool is_whole() const { return is_whole_; }
  /// Whether the file has its index.
  bool is_indexed() const { return is_indexed_; }

 private:
  /// Position of a message.
  struct Entry {
    ros::Time time;
    std::uint32_t offset;  ///< position in its chunk
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
  /// Writes the first record with the position of the index; 0 = no index.
  void write_head(std::uint64_t index);
  bool put(const std::string& bytes);

  File file_;
  bool is_whole_ = true, is_indexed_ = false;
  std::uint64_t end_ = 0;                    ///< end of the complete chunks
  std::vector<std::string> connections_;     ///< records
  std::vector<std::vector<Entry>> entries_;  ///< of the current chunk, by topic
  std::vector<Chunk> chunks_;
  std::string chunk_;  ///< current chunk
  std::string bytes_;  ///< of a message, stored to reuse its memory
};

}  // namespace quadcore::node
