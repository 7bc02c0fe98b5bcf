// A function of a known signature with its captures. Descriptions of options hold hundreds of these, each of a type of
// its own; they cost a third of the compile time of std::function.
#pragma once

#include <memory>
#include <utility>

namespace tunewright {

/// The captures of a callable, shared by its copies. Never inlined: they are copied where descriptions are put
/// together.
class Captured {
public:
    Captured() = default;
    // NOLINTBEGIN(modernize-use-equals-default,bugprone-unhandled-self-assignment): what is never inlined has a body
    [[gnu::noinline]] Captured(const void* state, void (*destroy)(const void*)) : state_(state, destroy) {}
    [[gnu::noinline]] Captured(const Captured& other) noexcept : state_(other.state_) {}
    [[gnu::noinline]] Captured(Captured&& other) noexcept : state_(std::move(other.state_)) {}
    [[gnu::noinline]] Captured& operator=(const Captured& other) noexcept {
        state_ = other.state_;
        return *this;
    }
    [[gnu::noinline]] Captured& operator=(Captured&& other) noexcept {
        state_ = std::move(other.state_);
        return *this;
    }
    [[gnu::noinline]] ~Captured() {}
    // NOLINTEND(modernize-use-equals-default,bugprone-unhandled-self-assignment)

    const void* get() const { return state_.get(); }

private:
    std::shared_ptr<const void> state_;
};

template <class F>
void destroy_captured(const void* state) {
    delete static_cast<const F*>(state);
}

template <class Signature>
class Callable;

/// A default-constructed one is empty and converts to false.
template <class R, class... A>
class Callable<R(A...)> {
public:
    Callable() = default;
    template <class F>
    Callable(F f) : call_(&call<F>), captured_(new F(std::move(f)), &destroy_captured<F>) {}

    R operator()(A... arguments) const { return call_(captured_.get(), static_cast<A&&>(arguments)...); }
    explicit operator bool() const { return call_ != nullptr; }

private:
    template <class F>
    static R call(const void* state, A... arguments) {
        return (*static_cast<const F*>(state))(static_cast<A&&>(arguments)...);
    }

    R (*call_)(const void*, A...) = nullptr;
    Captured captured_;
};

}  // namespace tunewright
