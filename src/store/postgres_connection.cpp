#include "store/postgres_connection.h"

#include "common/io/text_file.h"
#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

// libpq's messages end with a newline, and may have several lines.
std::string oneLine(const char* message) {
  std::string line = trimmed(message, " \n");
  for (char& c : line) {
    if (c == '\n') c = ' ';
  }
  return line;
}

struct FreeOptions {
  void operator()(PQconninfoOption* options) const { PQconninfoFree(options); }
};

}  // namespace

PostgresPlace parsePostgresPlace(const std::string& location) {
  PostgresPlace place;
  const size_t mark = location.rfind('#');
  place.uri = location.substr(0, mark);
  place.map = mark == std::string::npos ? "map" : location.substr(mark + 1);
  // What libpq says of it may hold the password.
  const std::unique_ptr<PQconninfoOption, FreeOptions> options(PQconninfoParse(place.uri.c_str(), nullptr));
  check(options != nullptr && place.map.find('@') == std::string::npos,
        "the address of the database server is none; it is postgresql://USER@HOST/DATABASE#MAP, and in a "
        "password %, @, /, : and # are written %25, %40, %2F, %3A and %23");
  const auto valueOf = [&](const std::string& keyword) -> std::string {
    for (const PQconninfoOption* option = options.get(); option->keyword != nullptr; ++option) {
      if (option->keyword == keyword && option->val != nullptr) return option->val;
    }
    return "";
  };
  const std::string user = valueOf("user"), port = valueOf("port");
  place.name = "postgresql://" + (user.empty() ? "" : user + "@") + valueOf("host") +
               (port.empty() ? "" : ":" + port) + "/" + valueOf("dbname") + "#" + place.map;
  return place;
}

PostgresConnection::PostgresConnection(const PostgresPlace& place)
    : name_(place.name), connection_(nullptr, PQfinish) {
  // Those before the URI are for what it does not say.
  const char* keywords[] = {"connect_timeout",  "tcp_user_timeout", "keepalives_idle", "keepalives_interval",
                            "keepalives_count", "application_name", "dbname",          nullptr};
  const char* values[] = {"10", "30000", "10", "5", "4", "depth_fusion", place.uri.c_str(), nullptr};
  connection_.reset(PQconnectdbParams(keywords, values, 1));
  check(connection_ != nullptr && PQstatus(connection_.get()) == CONNECTION_OK,
        name_ + " cannot be reached: " + oneLine(PQerrorMessage(connection_.get())) +
            "; is the server running, and are user and password right?");
  // Nobody waits for ever for a writer that is gone.
  execute("SET lock_timeout = '30s'");
  execute("SET idle_in_transaction_session_timeout = '60s'");
}

PostgresConnection::Result PostgresConnection::execute(const std::string& statement,
                                                       const std::vector<std::string>& parameters) {
  std::vector<const char*> values;
  std::vector<int> lengths;
  for (const std::string& parameter : parameters) {
    values.push_back(parameter.data());
    lengths.push_back(static_cast<int>(parameter.size()));
  }
  const std::vector<int> formats(parameters.size(), 1);
  PGresult* result = PQexecParams(connection_.get(), statement.c_str(), static_cast<int>(parameters.size()),
                                  nullptr, values.data(), lengths.data(), formats.data(), 1);
  Result owner(result);
  const ExecStatusType status = PQresultStatus(result);
  check(status == PGRES_COMMAND_OK || status == PGRES_TUPLES_OK,
        name_ + ": " + oneLine(PQerrorMessage(connection_.get())));
  return owner;
}

}  // namespace depth_fusion
