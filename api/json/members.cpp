#include <algorithm>

#include "api/json/json.h"

namespace tunewright::api {
namespace {

/// Walks over text that is known to be JSON without white space between its tokens. Of other text it makes something.
class Walk {
public:
    Walk(std::string_view json, std::initializer_list<std::string_view> names) : json_(json), names_(names) {}

    std::string run() {
        out_.reserve(json_.size());
        value(true);
        return std::move(out_);
    }

private:
    bool at(char c) const { return at_ < json_.size() && json_[at_] == c; }

    /// The token from `from` to here is passed on, or not.
    void pass(std::size_t from, bool kept) {
        if (kept) out_ += json_.substr(from, at_ - from);
    }

    std::string_view quoted() {
        const std::size_t from = at_++;
        while (at_ < json_.size() && json_[at_] != '"') at_ += json_[at_] == '\\' ? 2 : 1;
        at_ = std::min(at_ + 1, json_.size());
        return json_.substr(from, at_ - from);
    }

    void value(bool kept) {
        if (at('{')) return object(kept);
        if (at('[')) return array(kept);
        at_ = std::min(at_, json_.size());
        const std::size_t from = at_;
        if (at('"')) {
            quoted();
        } else {
            at_ = std::min(json_.find_first_of(",]}", at_), json_.size());
        }
        pass(from, kept);
    }

    void object(bool kept) {
        at_++;
        if (kept) out_ += '{';
        bool first = true;
        while (at_ < json_.size() && !at('}')) {
            if (at(',')) at_++;
            if (!at('"')) break;
            const std::string_view name = quoted();
            if (!at(':')) break;
            at_++;
            const bool stays = kept && std::ranges::find(names_, name.substr(1, name.size() - 2)) == names_.end();
            if (stays) out_.append(first ? "" : ",").append(name).append(":");
            first = first && !stays;
            value(stays);
        }
        at_++;
        if (kept) out_ += '}';
    }

    void array(bool kept) {
        const std::size_t from = at_++;
        pass(from, kept);
        while (at_ < json_.size() && !at(']')) {
            const std::size_t comma = at_;
            if (at(',')) at_++;
            pass(comma, kept);
            const std::size_t before = at_;
            value(kept);
            if (at_ == before) break;
        }
        at_++;
        if (kept) out_ += ']';
    }

    std::string_view json_;
    std::initializer_list<std::string_view> names_;
    std::size_t at_ = 0;
    std::string out_;
};

}  // namespace

std::string without_members(std::string_view json, std::initializer_list<std::string_view> names) {
    return Walk(json, names).run();
}

}  // namespace tunewright::api
