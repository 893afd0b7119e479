// One source for host and device: every function marked CDEM_HD compiles for both, on a number type T that is double
// on the GPU and a vector of doubles (core/lanes.hpp) on the CPU. Write with selects, no branch on a T.
#pragma once

#if defined(__CUDACC__)
#define CDEM_HD __host__ __device__ __forceinline__
#if defined(__CUDA_ARCH__)
#define CDEM_UNROLL _Pragma("unroll")
#else
#define CDEM_UNROLL
#endif
#else
#define CDEM_HD inline __attribute__((always_inline))
#define CDEM_UNROLL _Pragma("GCC unroll 24")
#endif
