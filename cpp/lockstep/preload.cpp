// A library to preload (LD_PRELOAD) into an autopilot: strict lockstep without changes of its
// source.
//
// The program must have one main loop that reads the clock, and threads that receive datagrams
// after select(). The clock of the main thread advances by 1 us per reading and by the duration of
// each sleep. At a horizon, the main thread waits for the simulator to move the horizon. Other
// threads only read the clock. Therefore all that the program computes depends on the received
// packets alone.
//
// The simulator holds the other end of the socket QUADCORE_LOCKSTEP (a file descriptor). When the
// main thread stands at the horizon, it writes 's' and the latest datagram that the program has
// sent to the port QUADCORE_ANSWERS since the last time, if any. It reads a `Command`.
// QUADCORE_PORTS
// ("9003:41000,...") replaces ports; packets to port 0 are discarded.

#include <dlfcn.h>
#include <netinet/in.h>
#include <pthread.h>
#include <sched.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <vector>

namespace {

constexpr std::int64_t kReading = 1000;        // ns; duration of a reading of the clock
constexpr std::int64_t kSecond = 1000000000;   // ns
constexpr std::int64_t kStart = 10 * kSecond;  // time at which the program starts
constexpr int kMostPorts = 16;

/// What the simulator lets the main thread do.
struct Command {
  std::int64_t horizon = kStart;  ///< ns; time up to which the main thread runs
  std::int64_t packets = 0;       ///< packets that are to be handled before, since the start
};

std::atomic<std::int64_t> clock_now{kStart};
Command command;
int simulator = -1;
int answer_port = -1;
int replaced_ports[kMostPorts][2];
int port_count = 0;
std::atomic<int> started_threads{0}, selecting_threads{0};
thread_local bool is_main = false, has_selected = false;
thread_local int received_packets = 0;

std::mutex mutex;  // of what follows
std::condition_variable has_handled;
std::int64_t handled_packets = 0;
std::vector<char> answer{'s'};

template <class Function>
Function* find_next(Function*, const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

bool is_in_lockstep() { return simulator >= 0; }

/// Sends the latest answer to the simulator and waits for its command; without a simulator, the
/// program ends.
void stand() {
  std::unique_lock<std::mutex> lock(mutex);
  const auto size = static_cast<ssize_t>(answer.size());
  if (send(simulator, answer.data(), answer.size(), MSG_NOSIGNAL) != size) _exit(0);
  answer.resize(1);
  lock.unlock();
  if (recv(simulator, &command, sizeof command, 0) != sizeof command) _exit(0);
  lock.lock();
  has_handled.wait(lock, [] { return handled_packets >= command.packets; });
}

/// Advances the clock of the main thread, which waits at the horizon.
void advance(std::int64_t duration) {
  clock_now += duration;
  while (clock_now > command.horizon) stand();
}

int find_port(int port) {
  for (int i = 0; i < port_count; ++i) {
    if (replaced_ports[i][0] == port) return replaced_ports[i][1];
  }
  return port;
}

/// Returns an address with its port replaced.
sockaddr_in replace_port(const sockaddr* address) {
  sockaddr_in replaced;
  std::memcpy(&replaced, address, sizeof replaced);
  replaced.sin_port = htons(static_cast<std::uint16_t>(find_port(ntohs(replaced.sin_port))));
  return replaced;
}

bool has_port(const sockaddr* address, socklen_t length) {
  return address != nullptr && address->sa_family == AF_INET && length >= sizeof(sockaddr_in);
}

__attribute__((constructor)) void begin() {
  is_main = true;
  if (const char* text = std::getenv("QUADCORE_LOCKSTEP")) simulator = std::atoi(text);
  if (const char* text = std::getenv("QUADCORE_ANSWERS")) answer_port = std::atoi(text);
  const char* rest = std::getenv("QUADCORE_PORTS");
  while (rest != nullptr && *rest != '\0' && port_count < kMostPorts) {
    char* end = nullptr;
    replaced_ports[port_count][0] = static_cast<int>(std::strtol(rest, &end, 10));
    if (*end != ':') break;
    replaced_ports[port_count++][1] = static_cast<int>(std::strtol(end + 1, &end, 10));
    rest = *end == ',' ? end + 1 : end;
  }
  unsetenv("LD_PRELOAD");  // programs that this one starts run as usual
}

}  // namespace

#define QUADCORE_EXPORT extern "C" __attribute__((visibility("default")))

QUADCORE_EXPORT int clock_gettime(clockid_t id, timespec* time) noexcept {
  static auto* const next = find_next(&clock_gettime, "clock_gettime");
  if (!is_in_lockstep()) return next(id, time);
  if (is_main) advance(kReading);
  const std::int64_t now = clock_now;
  time->tv_sec = now / kSecond;
  time->tv_nsec = now % kSecond;
  return 0;
}

QUADCORE_EXPORT int nanosleep(const timespec* duration, timespec* rest) {
  static auto* const next = find_next(&nanosleep, "nanosleep");
  if (!is_in_lockstep() || !is_main) return next(duration, rest);
  advance(duration->tv_sec * kSecond + duration->tv_nsec);
  if (rest != nullptr) *rest = timespec{};
  return 0;
}

QUADCORE_EXPORT int select(int count, fd_set* read, fd_set* write, fd_set* except, timeval* limit) {
  static auto* const next = find_next(&select, "select");
  if (is_in_lockstep() && !is_main) {
    if (received_packets > 0) {
      const std::lock_guard<std::mutex> lock(mutex);
      handled_packets += received_packets;
      has_handled.notify_one();
    }
    if (!has_selected) ++selecting_threads;
    received_packets = 0;
    has_selected = true;
  }
  return next(count, read, write, except, limit);
}

QUADCORE_EXPORT ssize_t recvfrom(int socket, void* data, size_t size, int flags, sockaddr* from,
                                 socklen_t* length) {
  static auto* const next = find_next(&recvfrom, "recvfrom");
  const ssize_t received = next(socket, data, size, flags, from, length);
  if (received >= 0) ++received_packets;
  return received;
}

/// Returns once the new thread waits for packets, so that none is lost.
QUADCORE_EXPORT int pthread_create(pthread_t* thread, const pthread_attr_t* attributes,
                                   void* (*function)(void*), void* argument) noexcept {
  static auto* const next = find_next(&pthread_create, "pthread_create");
  const int status = next(thread, attributes, function, argument);
  if (is_in_lockstep() && status == 0) {
    ++started_threads;
    while (selecting_threads < started_threads) sched_yield();
  }
  return status;
}

QUADCORE_EXPORT int bind(int socket, const sockaddr* address, socklen_t length) noexcept {
  static auto* const next = find_next(&bind, "bind");
  if (!has_port(address, length)) return next(socket, address, length);
  const sockaddr_in replaced = replace_port(address);
  return next(socket, reinterpret_cast<const sockaddr*>(&replaced), sizeof replaced);
}

QUADCORE_EXPORT ssize_t sendto(int socket, const void* data, size_t size, int flags,
                               const sockaddr* address, socklen_t length) {
  static auto* const next = find_next(&sendto, "sendto");
  if (!has_port(address, length)) return next(socket, data, size, flags, address, length);
  const int port = ntohs(reinterpret_cast<const sockaddr_in*>(address)->sin_port);
  if (is_in_lockstep() && port == answer_port) {
    const std::lock_guard<std::mutex> lock(mutex);
    answer.resize(1);
    answer.insert(answer.end(), static_cast<const char*>(data),
                  static_cast<const char*>(data) + size);
    return static_cast<ssize_t>(size);
  }
  const sockaddr_in replaced = replace_port(address);
  if (replaced.sin_port == 0) return static_cast<ssize_t>(size);
  return next(socket, data, size, flags, reinterpret_cast<const sockaddr*>(&replaced),
              sizeof replaced);
}
