#include "store/packed_row.h"

#include <zstd.h>

#include <memory>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

constexpr int kLevel = 1;  // of zstd; docs/maps.md has others

struct FreeContext {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
};

}  // namespace

std::string packed(std::string_view contents) {
  check(contents.size() <= kMaxRowBytes,
        "a row of " + std::to_string(contents.size()) + " bytes is too large");
  thread_local const std::unique_ptr<ZSTD_CCtx, FreeContext> context(ZSTD_createCCtx());
  check(context != nullptr, "zstd has no memory");
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, kLevel);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);
  std::string row(ZSTD_compressBound(contents.size()), '\0');
  const size_t bytes =
      ZSTD_compress2(context.get(), row.data(), row.size(), contents.data(), contents.size());
  check(ZSTD_isError(bytes) == 0, std::string("zstd: ") + ZSTD_getErrorName(bytes));
  row.resize(bytes);
  return row;
}

std::string unpacked(std::string_view row, const std::string& where) {
  const unsigned long long bytes = ZSTD_getFrameContentSize(row.data(), row.size());
  check(bytes <= kMaxRowBytes, where + " is damaged: it says nothing of its size, or too much");
  std::string contents(bytes, '\0');
  const size_t found = ZSTD_decompress(contents.data(), contents.size(), row.data(), row.size());
  check(ZSTD_isError(found) == 0 && found == contents.size(), where + " is damaged");
  return contents;
}

}  // namespace depth_fusion
