#include "submaps/block_store.h"

#include <algorithm>
#include <utility>

#include "depth_fusion/common/error.h"
#include "submaps/row_keys.h"

namespace depth_fusion {
namespace {

constexpr size_t kQueueBytes = size_t{64} << 20;  // that wait to be compressed, or to be taken, at most
constexpr size_t kBatchBytes = size_t{1} << 20;   // of a transaction
constexpr std::chrono::seconds kRetry{1};

size_t bytesOf(const BlockStore::GroupPtr& group) {
  size_t bytes = 0;
  if (group != nullptr) {
    for (const BlockGroup& layer : *group) bytes += layer.voxels.size();
  }
  return bytes;
}

size_t bytesOf(const BlockStore::RowsPtr& rows) {
  size_t bytes = 0;
  if (rows != nullptr) {
    for (const std::string& row : *rows) bytes += row.size();
  }
  return bytes;
}

std::string keyOf(const GroupKey& key, const LayerRow& layer) {
  return blocksKey(key.submap, layer.name, key.group);
}

BlockStore::Group unpackedRows(const GroupKey& key, const BlockStore::Rows& rows,
                               const std::vector<LayerRow>& layers, int block_size) {
  BlockStore::Group group;
  for (size_t i = 0; i < layers.size(); ++i)
    group.push_back(parseBlocks(rows[i], key.group, layers[i], block_size,
                                "the store's row " + readable(keyOf(key, layers[i]))));
  return group;
}

BlockStore::Rows rowsIn(DatabaseReader& reader, const GroupKey& key, const std::vector<LayerRow>& layers,
                        const std::string& place) {
  BlockStore::Rows rows;
  for (const LayerRow& layer : layers) {
    std::optional<std::string> row = reader.get(keyOf(key, layer));
    check(row.has_value(), place + " has lost a row, " + readable(keyOf(key, layer)));
    rows.push_back(std::move(*row));
  }
  return rows;
}

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

BlockStore::Rows packedRows(const GroupKey& key, const BlockStore::Group& group,
                            const std::vector<LayerRow>& layers, int block_size) {
  BlockStore::Rows rows;
  for (size_t i = 0; i < layers.size(); ++i)
    rows.push_back(blocksRow(group[i], key.group, layers[i], block_size));
  return rows;
}

BlockStore::BlockStore(const SubmapParameters& parameters, std::vector<LayerRow> layers, int block_size)
    : parameters_(parameters),
      layers_(std::move(layers)),
      block_size_(block_size),
      memory_limit_(static_cast<size_t>(parameters.memory_mib) << 20),
      disk_limit_(static_cast<size_t>(parameters.disk_mib) << 20),
      thread_([this] { run(); }) {}

BlockStore::~BlockStore() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = true;
  }
  has_work_.notify_all();
  thread_.join();
}

void BlockStore::put(const GroupKey& key, Group group) {
  Lock lock(mutex_);
  waitForRoom(lock);
  usage_.blocks_put += group.front().blocks.size();
  Entry& entry = entries_[key];
  hold(entry, nullptr, nullptr);
  forgetInDatabase(key, entry);
  hold(entry, std::make_shared<const Group>(std::move(group)), nullptr);
  to_pack_.push_back(key);
  has_work_.notify_one();
}

void BlockStore::putRows(const GroupKey& key, Rows rows, size_t blocks) {
  Lock lock(mutex_);
  waitForRoom(lock);
  usage_.blocks_put += blocks;
  Entry& entry = entries_[key];
  hold(entry, nullptr, nullptr);
  forgetInDatabase(key, entry);
  hold(entry, nullptr, std::make_shared<const Rows>(std::move(rows)));
  by_age_.push_back(key);
  has_work_.notify_one();
}

void BlockStore::waitForRoom(Lock& lock) {
  has_room_.wait(lock, [this] { return hasRoomNow() || !usage_.problem.empty(); });
}

bool BlockStore::hasRoomNow() const {
  return usage_.memory_bytes <= memory_limit_ + kQueueBytes && usage_.waiting_bytes <= kQueueBytes;
}

bool BlockStore::hasRoom() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return usage_.problem.empty() || usage_.memory_bytes < memory_limit_;
}

BlockStore::GroupPtr BlockStore::take(const GroupKey& key) {
  Lock lock(mutex_);
  const auto found = entries_.find(key);
  check(found != entries_.end(), "a group of blocks is taken that is not in the store");
  GroupPtr group = found->second.blocks;
  if (group == nullptr) {
    const RowsPtr rows = rowsOf(key, lock);
    lock.unlock();
    group = std::make_shared<const Group>(unpack(key, *rows));
    lock.lock();
  }
  usage_.blocks_taken += group->front().blocks.size();
  hold(found->second, nullptr, nullptr);
  forgetInDatabase(key, found->second);
  entries_.erase(found);
  has_room_.notify_all();
  return group;
}

std::unique_ptr<StoreSnapshot> BlockStore::snapshot(const std::vector<GroupKey>& keys) {
  std::unique_ptr<StoreSnapshot> snapshot(new StoreSnapshot(layers_, block_size_));
  const std::lock_guard<std::mutex> reading(database_mutex_);
  bool is_in_database = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const GroupKey& key : keys) {
      const auto found = entries_.find(key);
      if (found == entries_.end()) continue;
      snapshot->entries_.emplace_hint(snapshot->entries_.end(), *found);
      const Entry& entry = found->second;
      is_in_database = is_in_database || (entry.blocks == nullptr && entry.rows == nullptr);
    }
  }
  if (!is_in_database) return snapshot;
  database();
  // A server's connection holds one transaction at a time.
  snapshot->database_ =
      isOnServer(parameters_.store)
          ? std::shared_ptr<Database>(openDatabase(parameters_.store, DatabaseAccess::kRead))
          : database_;
  snapshot->reader_ = snapshot->database_->read();
  return snapshot;
}

BlockStore::RowsPtr BlockStore::rowsOf(const GroupKey& key, Lock& lock) {
  const Entry entry = entries_.at(key);
  if (entry.rows != nullptr) return entry.rows;
  lock.unlock();
  Rows rows = entry.blocks != nullptr ? packedRows(key, *entry.blocks, layers_, block_size_) : read(key);
  lock.lock();
  return std::make_shared<const Rows>(std::move(rows));
}

void BlockStore::readAhead(const std::vector<GroupKey>& keys) {
  const std::lock_guard<std::mutex> lock(mutex_);
  to_unpack_.insert(to_unpack_.end(), keys.begin(), keys.end());
  has_work_.notify_one();
}

void BlockStore::clear() {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (auto& [key, entry] : entries_) {
    hold(entry, nullptr, nullptr);
    forgetInDatabase(key, entry);
  }
  entries_.clear();
  for (auto* keys : {&to_pack_, &to_unpack_, &by_age_, &ahead_}) keys->clear();
  ahead_bytes_ = 0;
  has_work_.notify_one();
  has_room_.notify_all();
}

StoreUsage BlockStore::usage() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  StoreUsage usage = usage_;
  usage.groups_in_memory = entries_.size() - usage.groups_on_disk;
  return usage;
}

std::set<uint32_t> BlockStore::submapsInDatabase() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::set<uint32_t> submaps;
  for (const auto& [key, entry] : entries_) {
    if (entry.database_bytes > 0) submaps.insert(key.submap);
  }
  return submaps;
}

void BlockStore::hold(Entry& entry, GroupPtr blocks, RowsPtr rows) {
  const size_t waited = entry.rows == nullptr && entry.database_bytes == 0 ? bytesOf(entry.blocks) : 0;
  usage_.memory_bytes -= bytesOf(entry.blocks) + bytesOf(entry.rows);
  usage_.waiting_bytes -= waited;
  entry.blocks = std::move(blocks);
  entry.rows = std::move(rows);
  usage_.memory_bytes += bytesOf(entry.blocks) + bytesOf(entry.rows);
  if (entry.rows == nullptr && entry.database_bytes == 0) usage_.waiting_bytes += bytesOf(entry.blocks);
}

void BlockStore::forgetInDatabase(const GroupKey& key, Entry& entry) {
  if (entry.database_bytes == 0) return;
  usage_.disk_bytes -= std::exchange(entry.database_bytes, 0);
  --usage_.groups_on_disk;
  gone_.push_back(key);
}

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
    auto blocks = std::make_shared<const Group>(unpack(key, *rows));
    lock.lock();
    const auto still = entries_.find(key);
    if (still == entries_.end() || still->second.blocks != nullptr) return;
    ahead_.push_back(key);
    ahead_bytes_ += bytesOf(blocks);
    hold(still->second, std::move(blocks), still->second.rows);
    boundAhead();
  } catch (const std::exception&) {
    // Whoever takes it is told.
    if (!lock.owns_lock()) lock.lock();
  }
}

void BlockStore::boundAhead() {
  while (ahead_bytes_ > kQueueBytes && !ahead_.empty()) {
    const auto found = entries_.find(ahead_.front());
    ahead_.pop_front();
    if (found == entries_.end()) continue;
    Entry& entry = found->second;
    if (entry.rows != nullptr || entry.database_bytes > 0) hold(entry, nullptr, entry.rows);
  }
  ahead_bytes_ = 0;
  for (const GroupKey& key : ahead_) {
    const auto found = entries_.find(key);
    if (found != entries_.end()) ahead_bytes_ += bytesOf(found->second.blocks);
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

BlockStore::Rows BlockStore::read(const GroupKey& key) {
  const std::lock_guard<std::mutex> lock(database_mutex_);
  return rowsIn(*database().read(), key, layers_, database().name());
}

BlockStore::Group BlockStore::unpack(const GroupKey& key, const Rows& rows) const {
  return unpackedRows(key, rows, layers_, block_size_);
}

Database& BlockStore::database() {
  if (database_ == nullptr) database_ = openStore(parameters_.store);
  return *database_;
}

BlockStore::RowsPtr StoreSnapshot::rows(const GroupKey& key) {
  const BlockStore::Entry& entry = entries_.at(key);
  if (entry.rows != nullptr) return entry.rows;
  return std::make_shared<const BlockStore::Rows>(entry.blocks != nullptr
                                                      ? packedRows(key, *entry.blocks, layers_, block_size_)
                                                      : rowsIn(*reader_, key, layers_, database_->name()));
}

BlockStore::Group StoreSnapshot::group(const GroupKey& key) {
  const BlockStore::Entry& entry = entries_.at(key);
  return entry.blocks != nullptr ? *entry.blocks : unpackedRows(key, *rows(key), layers_, block_size_);
}

}  // namespace depth_fusion
