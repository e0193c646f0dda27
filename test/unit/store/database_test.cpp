// What every database must do, whatever it is.
#include "depth_fusion/store/database.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <thread>

#include "support/expect_error.h"
#include "support/postgres_server.h"
#include "support/temporary_folder.h"

namespace depth_fusion {
namespace {

using Rows = std::map<std::string, std::string>;

PostgresServer& server() {
  static PostgresServer instance;
  return instance;
}

class DatabaseTest : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (isPostgres() && PostgresServer::programs().empty())
      GTEST_SKIP() << "no PostgreSQL server here; the package postgresql brings one";
    location_ = isPostgres() ? server().uri(testing::UnitTest::GetInstance()->current_test_info()->name())
                             : folder_ / "rows.map";
  }
  bool isPostgres() const { return std::string(GetParam()) == "postgres"; }

  std::unique_ptr<Database> open(DatabaseAccess access = DatabaseAccess::kWrite) const {
    return openDatabase(location_, access);
  }
  static void write(Database& database, const Rows& rows) {
    const auto writer = database.write();
    for (const auto& [key, value] : rows) writer->put(key, value);
    writer->commit();
  }
  static Rows all(Database& database, const std::string& prefix = "") {
    Rows rows;
    database.read()->forEach(prefix, [&](const auto& key, const auto& value) { rows[key] = value; });
    return rows;
  }

  TemporaryFolder folder_;
  std::string location_;
};

TEST_P(DatabaseTest, ItGivesBackWhatWasWritten) {
  std::string bytes;
  for (int i = 0; i < 300; ++i) bytes += static_cast<char>(i * 7);
  const Rows rows = {{"a", ""}, {std::string("a\0b", 3), bytes}, {"\xff\xff", std::string(200000, 'x')}};
  write(*open(), rows);
  const auto database = open(DatabaseAccess::kRead);
  EXPECT_EQ(all(*database), rows);
  EXPECT_EQ(database->read()->get("a"), "");
  EXPECT_EQ(database->read()->get("b"), std::nullopt);
  EXPECT_GT(database->bytes(), 200000u);
}

TEST_P(DatabaseTest, KeysComeInTheirOrderAndByTheirPrefix) {
  Rows rows;
  for (int i = 0; i < 256; ++i) {
    rows[std::string("k") + static_cast<char>(i)] = std::to_string(i);
    rows[std::string("l\xff") + static_cast<char>(i)] = std::to_string(i);
  }
  const auto database = open();
  write(*database, rows);
  std::vector<std::string> keys;
  database->read()->forEach("l\xff", [&](const auto& key, const auto&) { keys.push_back(key); });
  ASSERT_EQ(keys.size(), 256u);
  for (int i = 0; i < 256; ++i) EXPECT_EQ(keys[i], std::string("l\xff") + static_cast<char>(i));
  EXPECT_EQ(all(*database), rows);
  EXPECT_TRUE(all(*database, "m").empty());
}

TEST_P(DatabaseTest, AnotherValueTakesThePlaceAndErasedRowsAreGone) {
  const auto database = open();
  write(*database, {{"a", "1"}, {"b", "2"}});
  const auto writer = database->write();
  writer->put("a", "3");
  writer->put("a", "4");
  writer->erase("b");
  writer->erase("never");
  EXPECT_EQ(writer->get("a"), "4") << "a writer reads what it wrote";
  writer->commit();
  EXPECT_EQ(all(*database), (Rows{{"a", "4"}}));
}

TEST_P(DatabaseTest, WhatIsNotCommittedHasNeverBeen) {
  const auto database = open();
  write(*database, {{"a", "1"}});
  {
    const auto writer = database->write();
    writer->clear();
    writer->put("b", std::string(1 << 23, 'x'));
    EXPECT_EQ(all(*database), (Rows{{"a", "1"}})) << "others do not see it yet";
  }
  EXPECT_EQ(all(*database), (Rows{{"a", "1"}}));
  const auto writer = database->write();
  writer->clear();
  writer->put("b", "2");
  writer->commit();
  EXPECT_EQ(all(*database), (Rows{{"b", "2"}}));
}

TEST_P(DatabaseTest, AReaderSeesOneState) {
  const auto database = open();
  write(*database, {{"a", "1"}, {"b", "1"}});
  const auto reader = database->read();
  EXPECT_EQ(reader->get("a"), "1");
  write(*database, {{"a", "2"}, {"b", "2"}});
  EXPECT_EQ(reader->get("b"), "1");
  EXPECT_EQ(database->read()->get("b"), "2");
}

TEST_P(DatabaseTest, ASecondWriterWaits) {
  const auto database = open();
  write(*database, {{"n", ""}});
  constexpr int kWriters = 4, kTimes = 10;
  std::vector<std::thread> writers;
  for (int i = 0; i < kWriters; ++i) {
    writers.emplace_back([this] {
      const auto mine = open();
      for (int k = 0; k < kTimes; ++k) {
        const auto writer = mine->write();
        writer->put("n", *writer->get("n") + "x");
        writer->commit();
      }
    });
  }
  for (std::thread& writer : writers) writer.join();
  EXPECT_EQ(database->read()->get("n")->size(), static_cast<size_t>(kWriters * kTimes));
}

TEST_P(DatabaseTest, OneThatIsOpenForReadingIsNotWritten) {
  write(*open(), {{"a", "1"}});
  expectError([&] { open(DatabaseAccess::kRead)->write(); }, {"opened for reading"});
}

TEST_P(DatabaseTest, OneThatIsNotThereCannotBeRead) {
  expectError([&] { open(DatabaseAccess::kRead); }, {"there is no map"});
}

INSTANTIATE_TEST_SUITE_P(Databases, DatabaseTest, testing::Values("lmdb", "postgres"),
                         [](const auto& info) { return std::string(info.param); });

TEST(PostgresDatabase, ServersThatDoNotAnswerAreNamedWithoutThePassword) {
  if (PostgresServer::programs().empty()) GTEST_SKIP() << "no PostgreSQL server here";
  PostgresServer mine;
  const auto without_password = [](const auto& action, const std::vector<std::string>& words) {
    expectError(action, words);
    try {
      action();
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find("secret"), std::string::npos) << error.what();
    }
  };
  without_password([&] { openDatabase(mine.uri("m", "secret"), DatabaseAccess::kWrite); },
                   {"robot@127.0.0.1", "#m", "password"});
  // On a server where nothing was ever kept.
  expectError([&] { openDatabase(mine.uri("m"), DatabaseAccess::kRead); }, {"there is no map", "#m"});
  EXPECT_EQ(openIfThere(mine.uri("m")), nullptr);
  const auto database = openDatabase(mine.uri("m"), DatabaseAccess::kWrite);
  mine.stop();
  expectError([&] { database->read(); }, {"cannot be reached", "is the server running"});
  mine.start();
  EXPECT_EQ(database->read()->get("a"), std::nullopt) << "it can be used on";
  without_password(
      [&] { openDatabase("postgresql://robot:secret@127.0.0.1:99999/x", DatabaseAccess::kRead); }, {"99999"});
  for (const char* uri : {"postgresql://robot:secret%zz@host/x", "postgresql://robot:a#secret@host/x#kitchen",
                          "postgresql://robot:secret@host:/a b:/x"})
    without_password([&] { openDatabase(uri, DatabaseAccess::kRead); }, {});
  EXPECT_EQ(placeName("postgresql://robot:secret@host/x#kitchen"), "postgresql://robot@host/x#kitchen");
}

// The key is too long for an index, and noise, which is not compressed.
TEST(PostgresDatabase, AWriterInWhichAStatementFailedDoesNotCommit) {
  if (PostgresServer::programs().empty()) GTEST_SKIP() << "no PostgreSQL server here";
  const auto database = openDatabase(server().uri("failing"), DatabaseAccess::kWrite);
  const auto writer = database->write();
  writer->put("a", "1");
  std::mt19937 random(1);
  std::string key(20000, '\0');
  for (char& byte : key) byte = static_cast<char>(random());
  writer->put(key, "2");
  EXPECT_THROW(writer->get("a"), Error);
  EXPECT_THROW(writer->commit(), Error);
  EXPECT_EQ(database->read()->get("a"), std::nullopt);
}

TEST(PostgresDatabase, MapsOfOneServerAreApart) {
  if (PostgresServer::programs().empty()) GTEST_SKIP() << "no PostgreSQL server here";
  for (const char* map : {"kitchen", "hall"}) {
    const auto writer = openDatabase(server().uri(map), DatabaseAccess::kWrite)->write();
    writer->put("name", map);
    writer->commit();
  }
  const auto hall = openDatabase(server().uri("hall"), DatabaseAccess::kWrite);
  EXPECT_EQ(hall->read()->get("name"), "hall");
  const auto writer = hall->write();
  writer->clear();
  writer->commit();
  EXPECT_EQ(openDatabase(server().uri("kitchen"), DatabaseAccess::kRead)->read()->get("name"), "kitchen");
}

}  // namespace
}  // namespace depth_fusion
