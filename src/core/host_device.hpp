// One source for host and device: every function marked CDEM_HD compiles for both, on a number type T that is double
// on the GPU and a vector of doubles (core/lanes.hpp) on the CPU. Write with selects, no branch on a T. CDEM_HD_CALL is
// for long functions that few points need: called, not copied into every point of an element.
#pragma once

#if defined(__CUDACC__)
#define CDEM_HD __host__ __device__ __forceinline__
#define CDEM_HD_CALL __host__ __device__ __noinline__
#if defined(__CUDA_ARCH__)
#define CDEM_UNROLL _Pragma("unroll")
#else
#define CDEM_UNROLL
#endif
#else
#define CDEM_HD inline __attribute__((always_inline))
#define CDEM_HD_CALL __attribute__((noinline))
#define CDEM_UNROLL _Pragma("GCC unroll 24")
#endif
