#include "api/historian/tags/loop_tags.h"

#include <algorithm>
#include <cctype>
#include <unordered_map>
#include <utility>

#include "api/csv/cell.h"
#include "api/csv/columns/column_facts.h"
#include "api/csv/columns/heading_words.h"
#include "api/csv/text.h"
#include "api/describe/suggest.h"

namespace tunewright::api {
namespace {

/// Parts of a loop in control systems. Other words of the roles, such as "valve", may belong to the loop's name.
constexpr std::string_view kParts[] = {"pv", "sp", "op", "mv", "sv", "co", "cv", "lmn", "out"};
constexpr std::string_view kQuality[] = {"quality", "qual", "status", "validity"};
/// The value of a parameter, as in OUT.CV and PV_IN.
constexpr std::string_view kValueOf[] = {"cv", "value", "val", "in", "out", "eu"};
constexpr std::string_view kModes[] = {"mode", "modus", "modo", "betriebsart"};
constexpr std::string_view kBetween = " ._-/\\:!|[]()<>'";

constexpr int kUsualOrder = 100, kLetterOrder = 500;  ///< behind the words of heading_words, which are fewer

/// The beginning of the text that holds the first `count` words.
std::string_view first_words(std::string_view text, std::size_t count) {
    std::size_t low = 0, high = text.size();
    while (low < high) {
        const std::size_t middle = (low + high + 1) / 2;
        if (words(text.substr(0, middle)).size() <= count)
            low = middle;
        else
            high = middle - 1;
    }
    std::string_view out = count == 0 ? std::string_view() : text.substr(0, low);
    while (!out.empty() && kBetween.find(out.back()) != kBetween.npos) out.remove_suffix(1);
    return trimmed(out);
}

std::string joined(const std::vector<std::string>& words, std::size_t count) {
    std::string out;
    for (std::size_t i = 0; i < count; ++i) out += words[i] + " ";
    return out;
}

/// "FIC101PV" as "FIC101.PV".
std::string with_point(std::string_view text) {
    const std::string lower = lower_case(text);
    for (const std::string_view part : {"pv", "sp", "op", "mv", "sv", "mode"}) {
        const std::size_t at = text.size() - std::min(text.size(), part.size());
        if (at > 0 && lower.ends_with(part) && is_digit(text[at - 1]))
            return std::string(text.substr(0, at)) + "." + std::string(text.substr(at));
    }
    return std::string(text);
}

/// A role at the end of a tag, and the number of words before it.
struct NamedRole {
    ColumnRole role;
    std::size_t before;
    int order;
};

bool has_mode_word(const std::vector<std::string>& words) {
    return std::ranges::any_of(words, [](const auto& word) { return is_one_of(word, kModes); });
}

/// A role that is named by two words with a blank between them: "FIC101 set point", "process value".
std::optional<NamedRole> role_of_two_words(const Heading& heading) {
    const auto& words = heading.words;
    if (words.size() < 2) return std::nullopt;
    const std::string two = words[words.size() - 2] + " " + words.back();
    if (!heading.name.ends_with(two)) return std::nullopt;
    for (const ColumnRole role : {kReferenceRole, kInputRole, kOutputRole})
        if (const auto at = place(two, role)) return NamedRole{role, words.size() - 2, *at};
    return std::nullopt;
}

/// A letter alone names a role only next to another word of its own: "loop1.y".
std::optional<NamedRole> role_of_letter(const std::vector<std::string>& words) {
    for (const auto& [letter, role] : {std::pair{"y", kOutputRole}, {"u", kInputRole}, {"r", kReferenceRole}})
        if (words.size() > 1 && words.back() == letter) return NamedRole{role, words.size() - 1, kLetterOrder};
    return std::nullopt;
}

/// The role of the last word; those before it, such as a description of the plant, do not count.
std::optional<NamedRole> role_of_last_word(std::vector<std::string> words) {
    while (words.size() > 1 && is_one_of(words.back(), kValueOf) && is_one_of(words[words.size() - 2], kParts))
        words.pop_back();
    const std::size_t before = words.size() - 1;
    const std::string tail = before > 0 ? words[before - 1] + "." + words.back() : words.back();
    const Heading last = split_heading(tail);
    if (match(last, kReferenceRole)) {
        const auto at = place(words.back(), kReferenceRole);
        if (at || words.back() == "set") return NamedRole{kReferenceRole, before, at.value_or(kUsualOrder)};
        if (words.back() == "point" && before > 0) return NamedRole{kReferenceRole, before - 1, kUsualOrder};
        return std::nullopt;
    }
    if (is_auxiliary(last)) return std::nullopt;
    const Heading own = split_heading(words.back());
    for (const ColumnRole role : {kOutputRole, kInputRole}) {
        const auto found = match(own, role);
        if (found && found->level <= 2)
            return NamedRole{role, before, word_place(words.back(), role).value_or(found->order)};
    }
    return role_of_letter(words);
}

std::optional<NamedRole> role_at_end(const Heading& heading) {
    if (const auto mode = match(heading, kModeRole))
        return NamedRole{kModeRole, words(mode_stem(heading)).size(), mode->order};
    if (has_mode_word(heading.words)) return std::nullopt;  // the target mode is no target
    if (const auto two = role_of_two_words(heading)) return two;
    return role_of_last_word(heading.words);
}

/// "PV_FIC101" as "FIC101.PV"; "" if the first word is not a part of a loop.
std::string turned(const Heading& heading, std::string_view text) {
    const std::string& first = heading.words.front();
    if (heading.words.size() < 2 || !(is_one_of(first, kParts) || is_one_of(first, kModes))) return {};
    std::string_view rest = text.substr(first_words(text, 1).size());
    while (!rest.empty() && kBetween.find(rest.front()) != kBetween.npos) rest.remove_prefix(1);
    return std::string(rest) + "." + first;
}

/// Takes a word of quality off the end of the tag.
bool take_quality(std::string& text) {
    const std::vector<std::string> all = words(text);
    if (all.empty() || !is_one_of(all.back(), kQuality)) return false;
    text = std::string(first_words(text, all.size() - 1));
    return true;
}

/// The name of the tag without its unit, as written.
std::string_view without_unit(std::string_view text) {
    text = trimmed(text);
    return trimmed(text.substr(0, split_heading(text).name.size()));
}

}  // namespace

TagName split_tag(std::string_view tag) {
    TagName out;
    std::string text(without_unit(tag));
    out.quality = take_quality(text);
    text = with_point(text);
    Heading heading = split_heading(text);
    if (heading.words.empty()) return out;
    auto found = role_at_end(heading);
    const bool bare = found && found->before == 0 && heading.words.size() == 1;
    if (!found || (found->before == 0 && !bare)) {
        const std::string other = turned(heading, text);
        const auto role = other.empty() ? std::nullopt : role_at_end(split_heading(other));
        if (role && role->before > 0) {
            text = other;
            heading = split_heading(text);
            found = role;
        }
    }
    const std::size_t before = found ? found->before : heading.words.size();
    if (found) out.role = found->role, out.order = found->order;
    out.loop = std::string(first_words(text, before));
    out.key = joined(heading.words, before);
    // "PV1" and "OP1" belong together.
    if (found && before == 0) {
        const std::string number = number_behind(heading);
        if (!number.empty()) out.loop = "Loop " + number, out.key = "#" + number;
    }
    return out;
}

namespace {

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }

/// True for the letters of a controller behind the measured quantity: the IC of FIC, the FC of FFC, the QICA of AQICA.
bool are_of_controller(std::string_view letters) {
    constexpr std::string_view kModifiers = "dfryiq";
    constexpr std::size_t kMaxModifiers = 2, kMaxBehind = 2;
    for (std::size_t n = 0; n <= kMaxModifiers && n < letters.size(); ++n) {
        if (letters[n] == 'c' && letters.size() - n - 1 <= kMaxBehind) return true;
        if (kModifiers.find(letters[n]) == kModifiers.npos) return false;
    }
    return false;
}

}  // namespace

TagKind kind_of_tag(std::string_view tag) {
    using enum check::LoopKind;
    static constexpr std::pair<char, TagKind> kKinds[] = {{'f', {flow, "flow"}},
                                                          {'p', {pressure, "pressure"}},
                                                          {'l', {level, "level"}},
                                                          {'t', {temperature, "temperature"}},
                                                          {'a', {composition, "composition"}}};
    const std::string text = lower_case(tag);
    for (std::size_t at = 0; at < text.size(); ++at) {
        if (!is_letter(text[at])) continue;
        const std::size_t start = at;
        while (at < text.size() && is_letter(text[at])) ++at;
        for (const auto& [letter, kind] : kKinds)
            if (text[start] == letter && are_of_controller(std::string_view(text).substr(start + 1, at - start - 1)))
                return kind;
    }
    return {};
}

namespace {

class TagGrouper {
public:
    explicit TagGrouper(const std::vector<std::string>& tags) : tags_(tags), orders_(tags.size()) {}

    GroupedTags group() {
        for (std::size_t i = 0; i < tags_.size(); ++i) {
            const TagName name = split_tag(tags_[i]);
            name.quality ? add_quality(i, name) : add(i, name);
        }
        GroupedTags out;
        for (std::size_t k = 0; k < loops_.size(); ++k) {
            LoopTags& loop = loops_[k];
            for (const std::string& doubt : doubts_[k])
                if (loop.fault.empty()) loop.fault = doubt;
            const bool y = loop.at[kOutputRole].has_value(), u = loop.at[kInputRole].has_value();
            if (y && u)
                out.loops.push_back(std::move(loop));
            else if ((y || u) && !loop.name.empty())
                out.partial.push_back(std::move(loop.name));
        }
        return out;
    }

private:
    std::size_t group_of(const TagName& name) {
        const auto [found, fresh] = places_.try_emplace(name.key, loops_.size());
        if (fresh) {
            loops_.push_back({name.loop, {}, {}, {}});
            doubts_.emplace_back();
        }
        return found->second;
    }

    void add(std::size_t i, const TagName& name) {
        if (!name.role) return;
        const std::size_t group = group_of(name);
        std::optional<std::size_t>& place = loops_[group].at[*name.role];
        std::string& doubt = doubts_[group][*name.role];
        orders_[i] = name.order;
        if (!place || name.order < orders_[*place]) {
            place = i;
            doubt.clear();
        } else if (name.order == orders_[*place]) {
            doubt = in_quotes(tags_[*place]) + " and " + in_quotes(tags_[i]) + " may both be " +
                    role_meaning(*name.role) + ". Remove or rename one of them.";
        }
    }

    /// A column that says only "Quality" belongs to the column before it.
    void add_quality(std::size_t i, const TagName& name) {
        if (name.key.empty() && !name.role) {
            for (LoopTags& loop : loops_) {
                if (i > 0 && loop.at[kOutputRole] == i - 1) loop.y_quality = i;
                if (i > 0 && loop.at[kInputRole] == i - 1) loop.u_quality = i;
            }
            return;
        }
        LoopTags& loop = loops_[group_of(name)];
        if (!name.role || *name.role == kOutputRole) loop.y_quality = i;
        if (name.role == kInputRole) loop.u_quality = i;
    }

    const std::vector<std::string>& tags_;
    std::vector<LoopTags> loops_;
    std::vector<int> orders_;                                  ///< of each tag
    std::vector<std::array<std::string, kRoleCount>> doubts_;  ///< of each group and role: its tag is ambiguous
    std::unordered_map<std::string, std::size_t> places_;      ///< index in loops_ by key
};

}  // namespace

GroupedTags group_tags(const std::vector<std::string>& tags) { return TagGrouper(tags).group(); }

std::string partial_note(const std::vector<std::string>& partial) {
    constexpr std::size_t kMaxNamed = 5;
    if (partial.empty()) return {};
    std::vector<std::string> named(partial.begin(),
                                   partial.begin() + static_cast<std::ptrdiff_t>(std::min(partial.size(), kMaxNamed)));
    if (partial.size() > kMaxNamed) named.push_back(std::to_string(partial.size() - kMaxNamed) + " more");
    return listed(named, "and") + (partial.size() == 1 ? " has" : " have") +
           " only a measurement or only a controller output and " + (partial.size() == 1 ? "is" : "are") +
           " not checked.";
}

}  // namespace tunewright::api
