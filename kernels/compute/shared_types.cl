// The device's layout of the argument structs, for the test that compares it with the host's. One work-item.
//   layout  for each struct: its size; for each of its members: offset and size
#include "esdf/types.h"
#include "shared/types.h"
#include "shared/types_layout.h"

#define WRITE_STRUCT(type) layout[i++] = (int)sizeof(type);
#define WRITE_MEMBER(type, member)                             \
  {                                                            \
    type value;                                                \
    layout[i++] = (int)((char*)&value.member - (char*)&value); \
    layout[i++] = (int)sizeof(value.member);                   \
  }

__kernel void report_layout(__global int* layout) {
  if (get_global_id(0) > 0) return;
  int i = 0;
  FOR_EACH_SHARED_TYPE(WRITE_STRUCT, WRITE_MEMBER)
}
