// An autopilot with the structure of Betaflight's SITL: one main loop that reads the clock, threads
// that receive packets on fixed ports, outputs to a fixed port. Its outputs depend on the time of
// its clock, so that any difference in timing shows.

#include <arpa/inet.h>
#include <pthread.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <time.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

double state[18];
unsigned char radio[40];
double dies_at = 1e9;

sockaddr_in make_address(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

template <int port, class Data>
void* receive(void* data) {
  const int link = socket(AF_INET, SOCK_DGRAM, 0);
  const sockaddr_in address = make_address(port);
  if (bind(link, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) exit(7);
  for (;;) {
    fd_set set;
    FD_ZERO(&set);
    FD_SET(link, &set);
    timeval limit{0, 100000};
    if (select(link + 1, &set, nullptr, nullptr, &limit) == 1) {
      recvfrom(link, data, sizeof(Data), 0, nullptr, nullptr);
    }
  }
}

long long now_us() {
  timespec time;
  clock_gettime(CLOCK_MONOTONIC, &time);
  return time.tv_sec * 1000000LL + time.tv_nsec / 1000;
}

void set_parameters(const char* file) {
  FILE* stream = std::fopen(file, "r");
  char line[200];
  std::string values;
  while (std::fgets(line, sizeof line, stream) != nullptr) {
    if (std::strncmp(line, "set ", 4) == 0) std::printf("%s", line + 4);
  }
}

int main(int count, char** words) {
  if (count > 2 && std::strcmp(words[count - 2], "--config") == 0) {
    set_parameters(words[count - 1]);
    return 0;
  }
  if (count > 1) dies_at = std::atof(words[1]);
  const long long begin = now_us();
  pthread_t threads[2];
  pthread_create(&threads[0], nullptr, receive<9003, double[18]>, state);
  pthread_create(&threads[1], nullptr, receive<9004, unsigned char[40]>, radio);
  const int link = socket(AF_INET, SOCK_DGRAM, 0);
  const sockaddr_in motors = make_address(9002), raw = make_address(9001);
  const timespec start{0, 20000000};
  nanosleep(&start, nullptr);
  long long next = now_us();
  for (;;) {
    const long long now = now_us();
    if (now < next) continue;
    next += 500;
    if (state[0] > dies_at) std::abort();
    unsigned short arm;
    std::memcpy(&arm, radio + 16, sizeof arm);
    // A climb whose outputs contain the time of the clock and the height.
    const double level =
        arm > 1700 ? 0.9 + 1e-3 * ((now - begin) % 997) / 997 - 1e-5 * state[15] : 0;
    const float outputs[4] = {float(level), float(level), float(level), float(level)};
    sendto(link, outputs, sizeof outputs, 0, reinterpret_cast<const sockaddr*>(&motors),
           sizeof motors);
    sendto(link, outputs, sizeof outputs, 0, reinterpret_cast<const sockaddr*>(&raw), sizeof raw);
  }
}
