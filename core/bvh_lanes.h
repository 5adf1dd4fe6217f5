// SPDX-License-Identifier: GPL-3.0-or-later
// W floats at once, for the traversal kernels alone: each kernel file compiles this with its own instruction
// set, so everything here has internal linkage.
#pragma once

#include <cstdint>

#if defined(__SSE2__)
#include <immintrin.h>
#elif defined(__ARM_NEON)
#include <arm_neon.h>
#endif

namespace pnr {
namespace {

// The plain version, for any W and processor.
template <int W>
struct Lanes {
    float v[W];

    static Lanes load(const float* p) {
        Lanes r;
        for (int i = 0; i < W; ++i) r.v[i] = p[i];
        return r;
    }
    static Lanes all(float x) {
        Lanes r;
        for (int i = 0; i < W; ++i) r.v[i] = x;
        return r;
    }
    void store(float* p) const {
        for (int i = 0; i < W; ++i) p[i] = v[i];
    }
    template <class F>
    static Lanes each(const Lanes& a, const Lanes& b, F f) {
        Lanes r;
        for (int i = 0; i < W; ++i) r.v[i] = f(a.v[i], b.v[i]);
        return r;
    }
    friend Lanes operator+(Lanes a, Lanes b) {
        return each(a, b, [](float x, float y) { return x + y; });
    }
    friend Lanes operator-(Lanes a, Lanes b) {
        return each(a, b, [](float x, float y) { return x - y; });
    }
    friend Lanes operator*(Lanes a, Lanes b) {
        return each(a, b, [](float x, float y) { return x * y; });
    }
    friend Lanes min(Lanes a, Lanes b) {
        return each(a, b, [](float x, float y) { return x < y ? x : y; });
    }
    friend Lanes max(Lanes a, Lanes b) {
        return each(a, b, [](float x, float y) { return x > y ? x : y; });
    }
    friend Lanes abs(Lanes a) {
        return each(a, a, [](float x, float) { return __builtin_fabsf(x); });
    }
    friend unsigned less_equal(Lanes a, Lanes b) { // one bit a lane
        unsigned bits = 0;
        for (int i = 0; i < W; ++i) bits |= static_cast<unsigned>(a.v[i] <= b.v[i]) << i;
        return bits;
    }
};

#if defined(__SSE2__) && !defined(PNR_PLAIN_LANES)
template <>
struct Lanes<4> {
    __m128 v;
    static Lanes load(const float* p) { return {_mm_load_ps(p)}; }
    static Lanes all(float x) { return {_mm_set1_ps(x)}; }
    void store(float* p) const { _mm_store_ps(p, v); }
    friend Lanes operator+(Lanes a, Lanes b) { return {_mm_add_ps(a.v, b.v)}; }
    friend Lanes operator-(Lanes a, Lanes b) { return {_mm_sub_ps(a.v, b.v)}; }
    friend Lanes operator*(Lanes a, Lanes b) { return {_mm_mul_ps(a.v, b.v)}; }
    friend Lanes min(Lanes a, Lanes b) { return {_mm_min_ps(a.v, b.v)}; }
    friend Lanes max(Lanes a, Lanes b) { return {_mm_max_ps(a.v, b.v)}; }
    friend Lanes abs(Lanes a) { return {_mm_andnot_ps(_mm_set1_ps(-0.0f), a.v)}; }
    friend unsigned less_equal(Lanes a, Lanes b) {
        return static_cast<unsigned>(_mm_movemask_ps(_mm_cmple_ps(a.v, b.v)));
    }
};
#elif defined(__ARM_NEON) && !defined(PNR_PLAIN_LANES)
template <>
struct Lanes<4> {
    float32x4_t v;
    static Lanes load(const float* p) { return {vld1q_f32(p)}; }
    static Lanes all(float x) { return {vdupq_n_f32(x)}; }
    void store(float* p) const { vst1q_f32(p, v); }
    friend Lanes operator+(Lanes a, Lanes b) { return {vaddq_f32(a.v, b.v)}; }
    friend Lanes operator-(Lanes a, Lanes b) { return {vsubq_f32(a.v, b.v)}; }
    friend Lanes operator*(Lanes a, Lanes b) { return {vmulq_f32(a.v, b.v)}; }
    friend Lanes min(Lanes a, Lanes b) { return {vminq_f32(a.v, b.v)}; }
    friend Lanes max(Lanes a, Lanes b) { return {vmaxq_f32(a.v, b.v)}; }
    friend Lanes abs(Lanes a) { return {vabsq_f32(a.v)}; }
    friend unsigned less_equal(Lanes a, Lanes b) {
        const uint32x4_t bit = {1, 2, 4, 8};
        return vaddvq_u32(vandq_u32(vcleq_f32(a.v, b.v), bit));
    }
};
#endif

#if defined(__AVX2__) && !defined(PNR_PLAIN_LANES)
template <>
struct Lanes<8> {
    __m256 v;
    static Lanes load(const float* p) { return {_mm256_load_ps(p)}; }
    static Lanes all(float x) { return {_mm256_set1_ps(x)}; }
    void store(float* p) const { _mm256_store_ps(p, v); }
    friend Lanes operator+(Lanes a, Lanes b) { return {_mm256_add_ps(a.v, b.v)}; }
    friend Lanes operator-(Lanes a, Lanes b) { return {_mm256_sub_ps(a.v, b.v)}; }
    friend Lanes operator*(Lanes a, Lanes b) { return {_mm256_mul_ps(a.v, b.v)}; }
    friend Lanes min(Lanes a, Lanes b) { return {_mm256_min_ps(a.v, b.v)}; }
    friend Lanes max(Lanes a, Lanes b) { return {_mm256_max_ps(a.v, b.v)}; }
    friend Lanes abs(Lanes a) { return {_mm256_andnot_ps(_mm256_set1_ps(-0.0f), a.v)}; }
    friend unsigned less_equal(Lanes a, Lanes b) {
        return static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(a.v, b.v, _CMP_LE_OQ)));
    }
};
#endif

#if defined(__AVX512F__) && !defined(PNR_PLAIN_LANES)
template <>
struct Lanes<16> {
    __m512 v;
    static Lanes load(const float* p) { return {_mm512_load_ps(p)}; }
    static Lanes all(float x) { return {_mm512_set1_ps(x)}; }
    void store(float* p) const { _mm512_store_ps(p, v); }
    friend Lanes operator+(Lanes a, Lanes b) { return {_mm512_add_ps(a.v, b.v)}; }
    friend Lanes operator-(Lanes a, Lanes b) { return {_mm512_sub_ps(a.v, b.v)}; }
    friend Lanes operator*(Lanes a, Lanes b) { return {_mm512_mul_ps(a.v, b.v)}; }
    friend Lanes min(Lanes a, Lanes b) { return {_mm512_min_ps(a.v, b.v)}; }
    friend Lanes max(Lanes a, Lanes b) { return {_mm512_max_ps(a.v, b.v)}; }
    friend unsigned less_equal(Lanes a, Lanes b) {
        return static_cast<unsigned>(_mm512_cmp_ps_mask(a.v, b.v, _CMP_LE_OQ));
    }
};
#endif

} // namespace
} // namespace pnr
