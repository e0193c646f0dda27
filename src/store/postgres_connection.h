// A connection of libpq that throws.
#pragma once

#include <libpq-fe.h>

#include <memory>
#include <string>
#include <vector>

namespace depth_fusion {

// Where a map is on a server.
struct PostgresPlace {
  std::string uri;   // of libpq
  std::string map;   // its name there
  std::string name;  // of both, for messages: without a password
};

// Throws Error for what libpq does not take.
PostgresPlace parsePostgresPlace(const std::string& location);

class PostgresConnection {
 public:
  // Throws Error if the server does not answer in 10 s, or does not let us in.
  explicit PostgresConnection(const PostgresPlace& place);

  // The result of a statement; parameters and result are bytes. Throws Error for one that fails.
  class Result {
   public:
    explicit Result(PGresult* result) : result_(result, PQclear) {}
    int rows() const { return PQntuples(result_.get()); }
    // What was done, as "COMMIT".
    std::string tag() const { return PQcmdStatus(result_.get()); }
    std::string bytes(int row, int column) const {
      return {PQgetvalue(result_.get(), row, column),
              static_cast<size_t>(PQgetlength(result_.get(), row, column))};
    }

   private:
    std::unique_ptr<PGresult, decltype(&PQclear)> result_;
  };
  Result execute(const std::string& statement, const std::vector<std::string>& parameters = {});

 private:
  std::string name_;
  std::unique_ptr<PGconn, decltype(&PQfinish)> connection_;
};

}  // namespace depth_fusion
