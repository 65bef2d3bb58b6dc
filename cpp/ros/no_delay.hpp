#pragma once

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

namespace quadcore::node {

/// Makes every TCP connection of this process send at once. A subscriber may ask roscpp for that,
/// but few do, and then a message can wait 40 ms for the acknowledgement of the one before: fatal
/// in lockstep. roscpp offers the publisher no way to choose, so its sockets are set here; call
/// when a subscriber has connected.
inline void send_without_delay() {
  constexpr int most_descriptors = 1024;
  constexpr int yes = 1;
  for (int descriptor = 0; descriptor < most_descriptors; ++descriptor) {
    // Anything else than a TCP socket refuses, which is as well.
    setsockopt(descriptor, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  }
}

}  // namespace quadcore::node
