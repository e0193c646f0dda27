#include "submaps/block_store.h"

#include <utility>

#include "depth_fusion/common/error.h"

namespace depth_fusion {

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

void BlockStore::put(const GroupKey& key, BlockGroups group) {
  const size_t blocks = group.front().blocks.size();
  replace(key, std::make_shared<const BlockGroups>(std::move(group)), nullptr, blocks, to_pack_);
}

void BlockStore::putRows(const GroupKey& key, GroupRows rows, size_t blocks) {
  replace(key, nullptr, std::make_shared<const GroupRows>(std::move(rows)), blocks, by_age_);
}

void BlockStore::replace(const GroupKey& key, GroupPtr group, RowsPtr rows, size_t blocks,
                         std::deque<GroupKey>& queue) {
  Lock lock(mutex_);
  has_room_.wait(lock, [this] { return hasRoomNow() || !usage_.problem.empty(); });
  usage_.blocks_put += blocks;
  Entry& entry = entries_[key];
  hold(entry, nullptr, nullptr);
  forgetInDatabase(key, entry);
  hold(entry, std::move(group), std::move(rows));
  queue.push_back(key);
  has_work_.notify_one();
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
    group = std::make_shared<const BlockGroups>(unpack(key, *rows));
    lock.lock();
  }
  usage_.blocks_taken += group->front().blocks.size();
  hold(found->second, nullptr, nullptr);
  forgetInDatabase(key, found->second);
  entries_.erase(found);
  has_room_.notify_all();
  return group;
}

BlockStore::RowsPtr BlockStore::rowsOf(const GroupKey& key, Lock& lock) {
  const Entry entry = entries_.at(key);
  if (entry.rows != nullptr) return entry.rows;
  lock.unlock();
  GroupRows rows = entry.blocks != nullptr ? packedRows(key, *entry.blocks, layers_, block_size_) : read(key);
  lock.lock();
  return std::make_shared<const GroupRows>(std::move(rows));
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
  for (auto* keys : {&to_pack_, &to_unpack_, &by_age_}) keys->clear();
  ahead_.clear();
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

GroupRows BlockStore::read(const GroupKey& key) {
  const std::lock_guard<std::mutex> lock(database_mutex_);
  return rowsIn(*database().read(), key, layers_, database().name());
}

BlockGroups BlockStore::unpack(const GroupKey& key, const GroupRows& rows) const {
  return unpackedRows(key, rows, layers_, block_size_);
}

}  // namespace depth_fusion
