// A store's groups as they were at a time.
#include "depth_fusion/common/error.h"
#include "submaps/block_store.h"

namespace depth_fusion {

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

BlockStore::RowsPtr StoreSnapshot::rows(const GroupKey& key) {
  const BlockStore::Entry& entry = entries_.at(key);
  if (entry.rows != nullptr) return entry.rows;
  return std::make_shared<const GroupRows>(entry.blocks != nullptr
                                               ? packedRows(key, *entry.blocks, layers_, block_size_)
                                               : rowsIn(*reader_, key, layers_, database_->name()));
}

BlockGroups StoreSnapshot::group(const GroupKey& key) {
  const BlockStore::Entry& entry = entries_.at(key);
  return entry.blocks != nullptr ? *entry.blocks : unpackedRows(key, *rows(key), layers_, block_size_);
}

}  // namespace depth_fusion
