// Rows of bytes by key, on disk or on a server, written in transactions: where maps are kept.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace depth_fusion {

// Keys and values are bytes; keys have 1 to 500 of them and are ordered as std::string orders them.
class DatabaseReader {
 public:
  using Visit = std::function<void(const std::string& key, const std::string& value)>;

  virtual ~DatabaseReader() = default;
  virtual std::optional<std::string> get(const std::string& key) = 0;
  // The rows whose keys begin with the prefix, in the order of their keys.
  virtual void forEach(const std::string& prefix, const Visit& visit) = 0;
};

// What a writer writes is seen by others, and lasts, as a whole from its commit on. One that ends without it,
// by an exception or with the process, has never been. Others write before or after it, not beside it.
class DatabaseWriter : public DatabaseReader {
 public:
  virtual void put(const std::string& key, const std::string& value) = 0;
  // Also of a key that there is not.
  virtual void erase(const std::string& key) = 0;
  // All the rows.
  virtual void clear() = 0;
  virtual void commit() = 0;
};

// One thread at a time uses it and its readers and writers. Everything throws Error, naming the place, where
// the database fails; the database can be used on after it.
class Database {
 public:
  virtual ~Database() = default;
  // The rows as they are now, whatever others write meanwhile.
  virtual std::unique_ptr<DatabaseReader> read() = 0;
  // Waits for whoever writes.
  virtual std::unique_ptr<DatabaseWriter> write() = 0;
  // What it takes where it lies.
  virtual uint64_t bytes() = 0;
  // Whether what was opened is still what the place names.
  virtual bool isThere() const = 0;
  // Its place for messages: without a password.
  virtual std::string name() const = 0;
};

enum class DatabaseAccess { kRead, kWrite };

// Whether the place is one on a server rather than a file's path.
bool isOnServer(const std::string& location);

// Opens the database at a place: the path of a file (LMDB), or `postgresql://USER@HOST/DATABASE#MAP`, a
// connection URI of libpq with the name of one of the maps that are kept there ("map" without one). A file,
// or a table, that is not there is made for kWrite. Throws Error if there is none to be read, for a file that
// is none or is damaged, and for a server that does not answer.
std::unique_ptr<Database> openDatabase(const std::string& location, DatabaseAccess access);

// Opens the database there to be read; null if there is none. Makes nothing.
std::unique_ptr<Database> openIfThere(const std::string& location);

// An empty database for this process alone, in a file of the folder (empty: the system's for temporary files)
// that is gone with it. What is written does not outlast the machine. Throws Error if it cannot be made.
std::unique_ptr<Database> openScratch(const std::string& folder);

// The place for messages: without a password. Throws Error for an address that is none.
std::string placeName(const std::string& location);

// Throws Error if nothing can be written there; makes nothing.
void checkPlace(const std::string& location);

}  // namespace depth_fusion
