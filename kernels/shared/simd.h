// Vectors of SIMD_WIDTH lanes for OpenCL C: one lane a work-item on a GPU, 8 or 16 on a CPU.
// Masks are integers: vectors hold 0 or -1 a lane, scalars 0 or 1 as the comparison operators give.
#ifndef SIMD_WIDTH
#define SIMD_WIDTH 1
#endif

// PoCL would call large functions, and copy their structs byte by byte; so they are inlined by force.
#undef inline
#define inline static __attribute__((always_inline))

// Accesses a vector of global memory whose address is a multiple of its size. vload and vstore assume less,
// so that PoCL stores bytes one by one.
#define ALIGNED(type, pointer) (*(__global type*)(pointer))

// Asks for the cache line that a byte of global memory lies in. PoCL's prefetch() does nothing.
#define CACHE_LINE 64
#if SIMD_WIDTH > 1 && defined(POCL_DEVICE_ADDRESS_BITS)
#define PREFETCH(pointer) __builtin_prefetch((const void*)(size_t)(pointer))
#else
#define PREFETCH(pointer)
#endif

#define SIMD_JOIN_(a, b) a##b
#define SIMD_JOIN(a, b) SIMD_JOIN_(a, b)

#if SIMD_WIDTH == 1
typedef float vfloat;
typedef int vint;
typedef uint vuint;
typedef char vchar;
typedef uchar vuchar;
#define VLOAD(pointer) (*(pointer))
#define VSTORE(value, pointer) (*(pointer) = (value))
#define TO_VFLOAT(x) convert_float(x)
#define TO_VINT(x) convert_int(x)
#define TO_VCHAR(x) convert_char(x)
#define TO_VUCHAR(x) convert_uchar(x)
#define AS_VINT(x) as_int(x)
#define AS_VUINT(x) as_uint(x)
#define AS_VUCHAR(x) as_uchar(x)
#define AS_VFLOAT(x) as_float(x)
#define TO_VMASK8(mask) convert_char(mask)
#define ANY(mask) ((mask) != 0)
#define NOT(mask) (!(mask))
#define LANE_INDICES 0
#define GATHER(type, pointer, i) ((pointer)[i])
#define GATHER_BYTES(pointer, i) ((int)(pointer)[i])
#define GATHER_FOUR_BYTES(pointer, i) as_int(vload4(0, (pointer) + (i)))
inline uint gather_from_memory(__global const uint* words, const int* index) { return words[*index]; }
#define SUM_LANES(v) (v)
#define LEAST(v) (v)
#define FIRST_LANE(v) (v)
#define EVEN_LANES(a, b) (a)
#define ODD_LANES(a, b) (b)
#else
typedef SIMD_JOIN(float, SIMD_WIDTH) vfloat;
typedef SIMD_JOIN(int, SIMD_WIDTH) vint;
typedef SIMD_JOIN(uint, SIMD_WIDTH) vuint;
typedef SIMD_JOIN(char, SIMD_WIDTH) vchar;
typedef SIMD_JOIN(uchar, SIMD_WIDTH) vuchar;
#define VLOAD(pointer) SIMD_JOIN(vload, SIMD_WIDTH)(0, pointer)
#define VSTORE(value, pointer) SIMD_JOIN(vstore, SIMD_WIDTH)(value, 0, pointer)
#define TO_VFLOAT(x) SIMD_JOIN(convert_float, SIMD_WIDTH)(x)
#define TO_VINT(x) SIMD_JOIN(convert_int, SIMD_WIDTH)(x)
#define TO_VCHAR(x) SIMD_JOIN(convert_char, SIMD_WIDTH)(x)
#define TO_VUCHAR(x) SIMD_JOIN(convert_uchar, SIMD_WIDTH)(x)
#define AS_VINT(x) SIMD_JOIN(as_int, SIMD_WIDTH)(x)
#define AS_VUINT(x) SIMD_JOIN(as_uint, SIMD_WIDTH)(x)
#define AS_VUCHAR(x) SIMD_JOIN(as_uchar, SIMD_WIDTH)(x)
#define AS_VFLOAT(x) SIMD_JOIN(as_float, SIMD_WIDTH)(x)
#define TO_VMASK8(mask) SIMD_JOIN(convert_char, SIMD_WIDTH)(mask)
#define ANY(mask) any_lane(mask)
#define NOT(mask) (~(mask))
#if SIMD_WIDTH == 8
#define LANE_INDICES ((vint)(0, 1, 2, 3, 4, 5, 6, 7))
#define EACH_LANE(type, of, p, i)                                                                   \
  ((type)(of(p, (i).s0), of(p, (i).s1), of(p, (i).s2), of(p, (i).s3), of(p, (i).s4), of(p, (i).s5), \
          of(p, (i).s6), of(p, (i).s7)))
#define WORDS_AT(p, i) ((vuint)(p[i[0]], p[i[1]], p[i[2]], p[i[3]], p[i[4]], p[i[5]], p[i[6]], p[i[7]]))
inline bool any_lane(int8 mask) { return as_long(convert_char8(mask)) != 0; }
inline float sum_lanes(float8 v) {
  const float4 a = v.lo + v.hi;
  const float2 b = a.lo + a.hi;
  return b.x + b.y;
}
inline float least_lane(float8 v) {
  const float4 a = min(v.lo, v.hi);
  const float2 b = min(a.lo, a.hi);
  return min(b.x, b.y);
}
#elif SIMD_WIDTH == 16
#define LANE_INDICES ((vint)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15))
#define EACH_LANE(type, of, p, i)                                                                   \
  ((type)(of(p, (i).s0), of(p, (i).s1), of(p, (i).s2), of(p, (i).s3), of(p, (i).s4), of(p, (i).s5), \
          of(p, (i).s6), of(p, (i).s7), of(p, (i).s8), of(p, (i).s9), of(p, (i).sa), of(p, (i).sb), \
          of(p, (i).sc), of(p, (i).sd), of(p, (i).se), of(p, (i).sf)))
#define WORDS_AT(p, i)                                                                               \
  ((vuint)(p[i[0]], p[i[1]], p[i[2]], p[i[3]], p[i[4]], p[i[5]], p[i[6]], p[i[7]], p[i[8]], p[i[9]], \
           p[i[10]], p[i[11]], p[i[12]], p[i[13]], p[i[14]], p[i[15]]))
inline bool any_lane(int16 mask) {
  const long2 lanes = as_long2(convert_char16(mask));
  return (lanes.x | lanes.y) != 0;
}
inline float sum_lanes(float16 v) {
  const float8 a = v.lo + v.hi;
  const float4 b = a.lo + a.hi;
  const float2 c = b.lo + b.hi;
  return c.x + c.y;
}
inline float least_lane(float16 v) {
  const float8 a = min(v.lo, v.hi);
  const float4 b = min(a.lo, a.hi);
  const float2 c = min(b.lo, b.hi);
  return min(c.x, c.y);
}
#endif
#define ELEMENT(pointer, i) ((pointer)[i])
#define GATHER(type, pointer, i) EACH_LANE(type, ELEMENT, pointer, i)
// Gathers signed bytes as integers. A gather of words, and shifts, are faster on CPUs than a gather of bytes.
#define GATHER_BYTES(pointer, i) \
  (GATHER(vint, (__global const int*)(pointer), (i) >> 2) << (24 - (((i)&3) << 3)) >> 24)
// Gathers four bytes from each place on; the first one is the lowest of a word.
typedef struct __attribute__((packed)) {
  int word;
} UnalignedInt;
#define FOUR_BYTES(pointer, i) (((__global const UnalignedInt*)((pointer) + (i)))->word)
#define GATHER_FOUR_BYTES(pointer, i) EACH_LANE(vint, FOUR_BYTES, pointer, i)
// Gathers words at indices that stand in memory. They are volatile, for otherwise PoCL takes the CPU's gather
// instruction, which is slower.
inline vuint gather_from_memory(__global const volatile uint* words, const int* indices) {
  return WORDS_AT(words, indices);
}
#define SUM_LANES(v) sum_lanes(v)
#define LEAST(v) least_lane(v)
#define FIRST_LANE(v) ((v).s0)
// Take every other lane of the two vectors, first of `a`, then of `b`.
#define EVEN_LANES(a, b) ((vfloat)((a).even, (b).even))
#define ODD_LANES(a, b) ((vfloat)((a).odd, (b).odd))
#endif
