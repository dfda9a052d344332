/* Several points abreast: loops over lanes that a compiler turns into vectors. Every lane goes through the same operations as one
 * alone, without fused ones (-ffp-contract=off), so that digits depend neither on lanes nor on vectors. */
#ifndef DEA_SUPPORT_LANES_H
#define DEA_SUPPORT_LANES_H

#include <stddef.h>

#define DEA_INLINE static inline __attribute__((always_inline))

enum { DEA_LANES = 8 };

#define DEA_EACH_LANE(l) for (size_t l = 0; l < DEA_LANES; l++)

/* DEA_LANES_DISPATCH(name, body, (parameters), (arguments)): function @p name that runs @p body, which is always inlined, compiled
 * for the widest vectors that the processor has. */
#if defined(__x86_64__) && defined(__GNUC__)
/* What wide vectors leave in the upper halves slows all that follows, five times in libm's pow(); compilers clear it only where they
 * optimise as with -O2. */
#define DEA_LANES_LEAVE() __builtin_ia32_vzeroupper()
#define DEA_LANES_DISPATCH(name, body, parameters, arguments)                                                                    \
    __attribute__((target("avx512f,avx512dq,avx512vl"), flatten)) static void name##_512 parameters                              \
    {                                                                                                                            \
        body arguments;                                                                                                          \
        DEA_LANES_LEAVE();                                                                                                       \
    }                                                                                                                            \
    __attribute__((target("avx2"), flatten)) static void name##_256 parameters                                                   \
    {                                                                                                                            \
        body arguments;                                                                                                          \
        DEA_LANES_LEAVE();                                                                                                       \
    }                                                                                                                            \
    static void name##_128 parameters                                                                                            \
    {                                                                                                                            \
        body arguments;                                                                                                          \
    }                                                                                                                            \
    static void name parameters                                                                                                  \
    {                                                                                                                            \
        if (__builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")) {                                          \
            name##_512 arguments;                                                                                                \
        } else if (__builtin_cpu_supports("avx2")) {                                                                             \
            name##_256 arguments;                                                                                                \
        } else {                                                                                                                 \
            name##_128 arguments;                                                                                                \
        }                                                                                                                        \
    }
#else
#define DEA_LANES_DISPATCH(name, body, parameters, arguments)                                                                    \
    static void name parameters                                                                                                  \
    {                                                                                                                            \
        body arguments;                                                                                                          \
    }
#endif

#endif
