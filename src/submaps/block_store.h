// Where blocks are that have left the pool.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include "depth_fusion/store/database.h"
#include "depth_fusion/submaps/store_usage.h"
#include "depth_fusion/submaps/submap_parameters.h"
#include "submaps/group_rows.h"

namespace depth_fusion {

class StoreSnapshot;

// Keeps groups in memory up to a limit, compressed, and beyond it in a database, the oldest first. A thread
// of its own compresses, writes and reads ahead; where it fails, it tries again every second, and nothing is
// lost. Any thread may call.
class BlockStore {
 public:
  using GroupPtr = std::shared_ptr<const BlockGroups>;
  using RowsPtr = std::shared_ptr<const GroupRows>;

  BlockStore(const SubmapParameters& parameters, std::vector<LayerRow> layers, int block_size);
  ~BlockStore();

  // Takes the group in; waits while the thread has too much to do. What was there of it is replaced.
  void put(const GroupKey& key, BlockGroups group);
  // The same of a group as rows, of so many blocks.
  void putRows(const GroupKey& key, GroupRows rows, size_t blocks);
  // The group, which is not here any more. Throws Error if it cannot be read; it stays then.
  GroupPtr take(const GroupKey& key);
  // The groups as they are now, to be read while this store goes on changing; those that are not here are
  // left out. Throws Error if the database cannot be read.
  std::unique_ptr<StoreSnapshot> snapshot(const std::vector<GroupKey>& keys);
  // The groups, as far as they are here, are taken soon.
  void readAhead(const std::vector<GroupKey>& keys);
  // Whether put() may be called: false while memory is full and the database fails.
  bool hasRoom() const;
  void clear();
  StoreUsage usage() const;
  // Submaps of which something is in the database.
  std::set<uint32_t> submapsInDatabase() const;

 private:
  friend class StoreSnapshot;
  // A group is in at least one of the three.
  struct Entry {
    GroupPtr blocks;
    RowsPtr rows;
    size_t database_bytes = 0;  // 0: it is not there
  };
  using Entries = std::map<GroupKey, Entry>;
  struct Ahead {
    GroupKey key;
    size_t bytes;
  };

  // So much waits to be compressed, or to be taken, at most.
  static constexpr size_t kQueueBytes = size_t{64} << 20;

  using KeyedRows = std::vector<std::pair<GroupKey, RowsPtr>>;
  using Lock = std::unique_lock<std::mutex>;
  using Clock = std::chrono::steady_clock;

  // The thread. Each piece of its work holds the lock but while it compresses, reads or writes.
  void run();
  void packNext(Lock& lock);
  void unpackNext(Lock& lock);
  void spill(Lock& lock);
  // The next groups to be written, the oldest first.
  KeyedRows oldestRows();
  void write(const KeyedRows& rows, const std::vector<GroupKey>& gone);
  // Forgets what was unpacked ahead first while there is too much of it, and what was taken by now.
  void boundAhead();

  // The group's rows, from wherever they are; the lock is let go of meanwhile.
  RowsPtr rowsOf(const GroupKey& key, Lock& lock);
  GroupRows read(const GroupKey& key);
  // Takes a group in, in place of what was there, and enters it in the queue of what is to be done with it.
  void replace(const GroupKey& key, GroupPtr group, RowsPtr rows, size_t blocks, std::deque<GroupKey>& queue);
  BlockGroups unpack(const GroupKey& key, const GroupRows& rows) const;
  Database& database();
  bool mustSpill() const { return usage_.memory_bytes > memory_limit_ && !by_age_.empty(); }
  bool hasRoomNow() const;
  // Sets what is in memory of a group.
  void hold(Entry& entry, GroupPtr blocks, RowsPtr rows);
  void forgetInDatabase(const GroupKey& key, Entry& entry);

  const SubmapParameters parameters_;
  const std::vector<LayerRow> layers_;
  const int block_size_;
  const size_t memory_limit_, disk_limit_;

  std::mutex database_mutex_;  // is taken before mutex_ where both are
  std::shared_ptr<Database> database_;

  mutable std::mutex mutex_;  // of all below
  std::condition_variable has_work_, has_room_;
  Entries entries_;
  std::deque<GroupKey> to_pack_, to_unpack_;
  std::deque<GroupKey> by_age_;  // with rows, the oldest first
  std::deque<Ahead> ahead_;      // unpacked before they are taken
  std::vector<GroupKey> gone_;   // with rows in the database that are not wanted any more
  size_t ahead_bytes_ = 0;
  Clock::time_point retry_at_;  // after a failure
  StoreUsage usage_;
  bool ends_ = false;
  std::thread thread_;
};

// Some of a store's groups as they were at a time. It may be used beside the store, by one thread.
class StoreSnapshot {
 public:
  bool has(const GroupKey& key) const { return entries_.count(key) > 0; }
  // The group as rows. Throws Error if it cannot be read.
  BlockStore::RowsPtr rows(const GroupKey& key);
  BlockGroups group(const GroupKey& key);

 private:
  friend class BlockStore;
  StoreSnapshot(std::vector<LayerRow> layers, int block_size)
      : layers_(std::move(layers)), block_size_(block_size) {}

  const std::vector<LayerRow> layers_;
  const int block_size_;
  std::map<GroupKey, BlockStore::Entry> entries_;
  std::shared_ptr<Database> database_;  // null: all are in memory
  std::unique_ptr<DatabaseReader> reader_;
};

}  // namespace depth_fusion
