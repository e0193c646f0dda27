// A PostgreSQL server of the test's own, on a free port of the loopback.
#pragma once

#include <netinet/in.h>
#include <pwd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "support/temporary_folder.h"

namespace depth_fusion {

// The server does not run as root: if the test does, it is run by the user `postgres`, which Debian's package
// makes.
class PostgresServer {
 public:
  // Where the server's programs are; empty if it is not installed.
  static std::string programs() {
    std::vector<std::string> found;
    std::error_code ignored;
    for (const auto& version : std::filesystem::directory_iterator("/usr/lib/postgresql", ignored)) {
      const std::string folder = version.path().string() + "/bin";
      if (std::filesystem::exists(folder + "/initdb")) found.push_back(folder);
    }
    return found.empty() ? "" : *std::max_element(found.begin(), found.end());
  }

  PostgresServer() : port_(freePort()) {
    if (geteuid() == 0) {
      const passwd* user = getpwnam("postgres");
      check(user != nullptr && chown(folder_.path().c_str(), user->pw_uid, user->pw_gid) == 0,
            "there is no user postgres to run the server");
    }
    std::ofstream(folder_ / "password") << kPassword << "\n";
    run("initdb --no-sync --locale=C -D '" + folder_ / "data" + "' -U robot --auth=scram-sha-256 --pwfile='" +
        folder_ / "password" + "'");
    start();
  }
  ~PostgresServer() {
    std::system(command("pg_ctl -D '" + folder_ / "data" + "' -m immediate stop").c_str());
  }

  void start() {
    run("pg_ctl -w -t 120 -D '" + folder_ / "data" + "' -l '" + folder_ / "log" + "' -o '-p " +
        std::to_string(port_) + " -k " + folder_.path() +
        " -c listen_addresses=127.0.0.1 -c fsync=off' start");
  }
  void stop() { run("pg_ctl -w -D '" + folder_ / "data" + "' -m fast stop"); }

  // The address of a map there.
  std::string uri(const std::string& map, const std::string& password = kPassword) const {
    return "postgresql://robot:" + password + "@127.0.0.1:" + std::to_string(port_) + "/postgres#" + map;
  }

  static constexpr char kPassword[] = "sesame";

 private:
  // Below those that the system gives away itself, so that it stays free while the server is stopped.
  static int freePort() {
    std::random_device random;
    while (true) {
      const int port = 20000 + static_cast<int>(random() % 10000);
      const int probe = socket(AF_INET, SOCK_STREAM, 0);
      sockaddr_in address{};
      address.sin_family = AF_INET;
      address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
      address.sin_port = htons(static_cast<uint16_t>(port));
      const bool is_free = bind(probe, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
      close(probe);
      if (is_free) return port;
    }
  }

  std::string command(const std::string& program) const {
    const std::string as_user = geteuid() == 0 ? "runuser -u postgres -- " : "";
    return "cd / && " + as_user + programs() + "/" + program + " >/dev/null 2>&1";
  }
  void run(const std::string& program) const {
    check(std::system(command(program).c_str()) == 0, "this failed: " + program);
  }

  TemporaryFolder folder_;
  int port_;
};

}  // namespace depth_fusion
