// SPDX-License-Identifier: GPL-3.0-or-later
// Large parts of small things. Both are values: copies share the part until one of them is changed.
#pragma once

#include <memory>
#include <optional>
#include <utility>

namespace pnr {

// std::optional with its value on the heap.
template <class T>
class Boxed {
public:
    Boxed() = default;
    Boxed(std::nullopt_t) {}
    Boxed(const T& value) : value_(std::make_shared<T>(value)) {}
    Boxed(T&& value) : value_(std::make_shared<T>(std::move(value))) {}

    bool has_value() const { return value_ != nullptr; }
    explicit operator bool() const { return has_value(); }
    const T& operator*() const { return *value_; }
    const T* operator->() const { return value_.get(); }
    T& operator*() { return own(); }
    T* operator->() { return &own(); }
    T value_or(const T& other) const { return value_ ? *value_ : other; }
    template <class... Arguments>
    T& emplace(Arguments&&... arguments) {
        value_ = std::make_shared<T>(std::forward<Arguments>(arguments)...);
        return *value_;
    }
    void reset() { value_.reset(); }

private:
    T& own() {
        if (value_.use_count() > 1) value_ = std::make_shared<T>(*value_);
        return *value_;
    }
    std::shared_ptr<T> value_;
};

// A T that takes no room while it is as T{} makes it.
template <class T>
class Seldom {
public:
    Seldom() = default;
    Seldom(const T& value) : value_(value) {}
    Seldom(T&& value) : value_(std::move(value)) {}

    const T& get() const {
        static const T usual{};
        return value_ ? *value_ : usual;
    }
    operator const T&() const { return get(); }
    const T* operator->() const { return &get(); }
    T& edit() {
        if (!value_) value_.emplace();
        return *value_;
    }

private:
    Boxed<T> value_;
};

} // namespace pnr
