// What a store's thread does: it compresses, writes and reads ahead.
#include <algorithm>
#include <utility>

#include "depth_fusion/common/error.h"
#include "submaps/block_store.h"
#include "submaps/row_keys.h"

namespace depth_fusion {
namespace {

constexpr size_t kBatchBytes = size_t{1} << 20;  // of a transaction
constexpr std::chrono::seconds kRetry{1};

// Opens what is of use to this map alone. Throws Error if it is in use for something else.
std::unique_ptr<Database> openStore(const std::string& location) {
  if (!isOnServer(location)) return openScratch(location);
  std::unique_ptr<Database> database = openDatabase(location, DatabaseAccess::kWrite);
  const std::unique_ptr<DatabaseWriter> writer = database->write();
  check(!writer->get(kDescriptionKey),
        database->name() + " holds a map; give submaps/store a place of its own, with another #NAME");
  writer->clear();
  writer->commit();
  return database;
}

}  // namespace

void BlockStore::run() {
  Lock lock(mutex_);
  while (!ends_) {
    const bool may_spill = usage_.problem.empty() || Clock::now() >= retry_at_;
    if (!to_unpack_.empty()) {
      unpackNext(lock);
    } else if (!to_pack_.empty()) {
      packNext(lock);
    } else if (mustSpill() && may_spill) {
      spill(lock);
    } else if (mustSpill()) {
      has_work_.wait_until(lock, retry_at_);
    } else {
      has_work_.wait(lock);
    }
  }
}

void BlockStore::packNext(Lock& lock) {
  const GroupKey key = to_pack_.front();
  to_pack_.pop_front();
  const auto found = entries_.find(key);
  if (found == entries_.end() || found->second.blocks == nullptr || found->second.rows != nullptr) return;
  const GroupPtr blocks = found->second.blocks;
  const Clock::time_point begin = Clock::now();
  const RowsPtr rows = rowsOf(key, lock);
  usage_.packing_s += std::chrono::duration<double>(Clock::now() - begin).count();
  const auto still = entries_.find(key);
  if (still == entries_.end() || still->second.blocks != blocks) return;  // it was taken, or put again
  usage_.bytes_packed += bytesOf(blocks);
  usage_.bytes_of_packed += bytesOf(rows);
  hold(still->second, nullptr, rows);
  by_age_.push_back(key);
  has_room_.notify_all();
}

void BlockStore::unpackNext(Lock& lock) {
  const GroupKey key = to_unpack_.front();
  to_unpack_.pop_front();
  const auto found = entries_.find(key);
  if (found == entries_.end() || found->second.blocks != nullptr) return;
  try {
    const RowsPtr rows = rowsOf(key, lock);
    lock.unlock();
    auto blocks = std::make_shared<const BlockGroups>(unpack(key, *rows));
    lock.lock();
    const auto still = entries_.find(key);
    if (still == entries_.end() || still->second.blocks != nullptr) return;
    ahead_.push_back({key, bytesOf(blocks)});
    ahead_bytes_ += ahead_.back().bytes;
    hold(still->second, std::move(blocks), still->second.rows);
    boundAhead();
  } catch (const std::exception&) {
    // Whoever takes it is told.
    if (!lock.owns_lock()) lock.lock();
  }
}

void BlockStore::boundAhead() {
  for (; !ahead_.empty(); ahead_.pop_front()) {
    const auto found = entries_.find(ahead_.front().key);
    const bool is_there = found != entries_.end() && found->second.blocks != nullptr &&
                          (found->second.rows != nullptr || found->second.database_bytes > 0);
    if (is_there && ahead_bytes_ <= kQueueBytes) return;
    if (is_there) hold(found->second, nullptr, found->second.rows);
    ahead_bytes_ -= ahead_.front().bytes;
  }
}

BlockStore::KeyedRows BlockStore::oldestRows() {
  KeyedRows oldest;
  std::set<GroupKey> chosen;  // a group that was put again stands there twice
  for (size_t bytes = 0; bytes < kBatchBytes && !by_age_.empty(); by_age_.pop_front()) {
    const GroupKey& key = by_age_.front();
    const auto found = entries_.find(key);
    if (found == entries_.end() || found->second.rows == nullptr || found->second.database_bytes > 0 ||
        !chosen.insert(key).second)
      continue;
    bytes += bytesOf(found->second.rows);
    oldest.emplace_back(key, found->second.rows);
  }
  return oldest;
}

void BlockStore::spill(Lock& lock) {
  const KeyedRows rows = oldestRows();
  std::vector<GroupKey> gone;
  gone.swap(gone_);
  const bool is_full = usage_.disk_bytes + kBatchBytes > disk_limit_;
  lock.unlock();
  std::string problem;
  try {
    check(!is_full, "the store has its " + std::to_string(parameters_.disk_mib) +
                        " MiB; raise submaps/disk_mib where there is room");
    write(rows, gone);
  } catch (const std::exception& error) {
    problem = error.what();
  }
  lock.lock();
  usage_.problem = problem;
  if (!problem.empty()) {
    retry_at_ = Clock::now() + kRetry;
    gone_.insert(gone_.end(), gone.begin(), gone.end());
    for (auto row = rows.rbegin(); row != rows.rend(); ++row) by_age_.push_front(row->first);
  } else {
    for (const auto& [key, written] : rows) {
      const auto found = entries_.find(key);
      if (found == entries_.end() || found->second.rows != written) {
        gone_.push_back(key);  // it was taken, or put again, meanwhile
        continue;
      }
      found->second.database_bytes = bytesOf(written);
      usage_.disk_bytes += found->second.database_bytes;
      ++usage_.groups_on_disk;
      hold(found->second, found->second.blocks, nullptr);
    }
  }
  has_room_.notify_all();
}

void BlockStore::write(const KeyedRows& rows, const std::vector<GroupKey>& gone) {
  const std::lock_guard<std::mutex> lock(database_mutex_);
  const std::unique_ptr<DatabaseWriter> writer = database().write();
  for (const GroupKey& key : gone) {
    for (const LayerRow& layer : layers_) writer->erase(keyOf(key, layer));
  }
  for (const auto& [key, row] : rows) {
    for (size_t i = 0; i < layers_.size(); ++i) writer->put(keyOf(key, layers_[i]), (*row)[i]);
  }
  writer->commit();
}

Database& BlockStore::database() {
  if (database_ == nullptr) database_ = openStore(parameters_.store);
  return *database_;
}

}  // namespace depth_fusion
