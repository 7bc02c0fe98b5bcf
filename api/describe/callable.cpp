#include "api/describe/callable.h"

namespace tunewright::api {

Captured::Captured(const void* state, void (*destroy)(const void*)) : state_(state, destroy) {}
Captured::Captured(const Captured&) noexcept = default;
Captured::Captured(Captured&&) noexcept = default;
Captured& Captured::operator=(const Captured&) noexcept = default;
Captured& Captured::operator=(Captured&&) noexcept = default;
Captured::~Captured() = default;

}  // namespace tunewright::api
