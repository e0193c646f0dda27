// Work that may end its process.
#pragma once

#include <functional>
#include <string>

namespace depth_fusion {

// Runs `work` in a process of its own while `read` reads what it writes to the other end of a pipe, to its
// end. Returns whether the process ended well: not if it died, or `work` threw. Throws Error if there can be
// no process.
bool runApart(const std::function<void(int pipe)>& work, const std::function<void(int pipe)>& read);

// All the bytes, or as many as come; false if fewer came or went.
bool readAll(int pipe, void* bytes, size_t count);
bool writeAll(int pipe, const void* bytes, size_t count);

}  // namespace depth_fusion
