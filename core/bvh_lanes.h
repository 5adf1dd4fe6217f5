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
    static Lanes rounded(const double* p) {
        Lanes r;
        for (int i = 0; i < W; ++i) r.v[i] = static_cast<float>(p[i]);
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
    friend Lanes operator/(Lanes a, Lanes b) {
        return each(a, b, [](float x, float y) { return x / y; });
    }
    friend Lanes multiply_subtract(Lanes a, Lanes b, Lanes c) {
        return a * b - c;
    } // fused where that is fast
    friend Lanes min(Lanes a, Lanes b) {
        return each(a, b, [](float x, float y) { return x < y ? x : y; });
    }
    friend Lanes max(Lanes a, Lanes b) {
        return each(a, b, [](float x, float y) { return x > y ? x : y; });
    }
    friend Lanes abs(Lanes a) {
        return each(a, a, [](float x, float) { return __builtin_fabsf(x); });
    }
    friend Lanes copy_sign(Lanes a, Lanes b) { // a >= 0
        return each(a, b, [](float x, float y) { return __builtin_copysignf(x, y); });
    }
    friend unsigned negative(Lanes a) {
        unsigned bits = 0;
        for (int i = 0; i < W; ++i) bits |= static_cast<unsigned>(__builtin_signbit(a.v[i]) != 0) << i;
        return bits;
    }
    friend Lanes turned(Lanes a) { // y z x, for the first three
        Lanes r = a;
        r.v[0] = a.v[1], r.v[1] = a.v[2], r.v[2] = a.v[0];
        return r;
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
    static Lanes rounded(const double* p) {
        // One by one: they have just been stored so, and wider loads would wait for that.
        const volatile double* one = p;
        const double a = one[0], b = one[1], c = one[2], d = one[3];
        return {_mm_movelh_ps(_mm_cvtpd_ps(_mm_set_pd(b, a)), _mm_cvtpd_ps(_mm_set_pd(d, c)))};
    }
    void store(float* p) const { _mm_store_ps(p, v); }
    friend Lanes operator+(Lanes a, Lanes b) { return {_mm_add_ps(a.v, b.v)}; }
    friend Lanes operator-(Lanes a, Lanes b) { return {_mm_sub_ps(a.v, b.v)}; }
    friend Lanes operator*(Lanes a, Lanes b) { return {_mm_mul_ps(a.v, b.v)}; }
    friend Lanes operator/(Lanes a, Lanes b) { return {_mm_div_ps(a.v, b.v)}; }
    friend Lanes multiply_subtract(Lanes a, Lanes b, Lanes c) { return a * b - c; }
    friend Lanes copy_sign(Lanes a, Lanes b) { return {_mm_or_ps(a.v, _mm_and_ps(_mm_set1_ps(-0.0f), b.v))}; }
    friend unsigned negative(Lanes a) { return static_cast<unsigned>(_mm_movemask_ps(a.v)); }
    friend Lanes turned(Lanes a) { return {_mm_shuffle_ps(a.v, a.v, _MM_SHUFFLE(3, 0, 2, 1))}; }
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
    static Lanes rounded(const double* p) {
        return {vcombine_f32(vcvt_f32_f64(vld1q_f64(p)), vcvt_f32_f64(vld1q_f64(p + 2)))};
    }
    void store(float* p) const { vst1q_f32(p, v); }
    friend Lanes operator+(Lanes a, Lanes b) { return {vaddq_f32(a.v, b.v)}; }
    friend Lanes operator-(Lanes a, Lanes b) { return {vsubq_f32(a.v, b.v)}; }
    friend Lanes operator*(Lanes a, Lanes b) { return {vmulq_f32(a.v, b.v)}; }
    friend Lanes operator/(Lanes a, Lanes b) { return {vdivq_f32(a.v, b.v)}; }
    friend Lanes multiply_subtract(Lanes a, Lanes b, Lanes c) {
        return {vnegq_f32(vfmsq_f32(c.v, a.v, b.v))};
    }
    friend Lanes copy_sign(Lanes a, Lanes b) { return {vbslq_f32(vdupq_n_u32(0x80000000u), b.v, a.v)}; }
    friend unsigned negative(Lanes a) {
        const uint32x4_t bit = {1, 2, 4, 8};
        return vaddvq_u32(vandq_u32(vcltzq_s32(vreinterpretq_s32_f32(a.v)), bit));
    }
    friend Lanes turned(Lanes a) { return {__builtin_shufflevector(a.v, a.v, 1, 2, 0, 3)}; }
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
    friend Lanes multiply_subtract(Lanes a, Lanes b, Lanes c) { return {_mm256_fmsub_ps(a.v, b.v, c.v)}; }
    friend Lanes min(Lanes a, Lanes b) { return {_mm256_min_ps(a.v, b.v)}; }
    friend Lanes max(Lanes a, Lanes b) { return {_mm256_max_ps(a.v, b.v)}; }
    friend Lanes abs(Lanes a) { return {_mm256_andnot_ps(_mm256_set1_ps(-0.0f), a.v)}; }
    friend unsigned less_equal(Lanes a, Lanes b) {
        return static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(a.v, b.v, _CMP_LE_OQ)));
    }
};
#endif

} // namespace
} // namespace pnr
