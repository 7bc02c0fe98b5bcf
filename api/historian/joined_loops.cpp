#include "api/historian/joined_loops.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "api/csv/cell.h"
#include "api/describe/suggest.h"
#include "api/historian/tags/loop_tags.h"
#include "api/historian/values/joined_tags.h"
#include "api/historian/values/value_cells.h"

namespace tunewright::api {
namespace {

std::size_t numbers_of(const TaggedLoop& loop) { return loop.t.size() + loop.y.size() + loop.u.size() + loop.r.size(); }

/// Appends a column of `to` rows; a column that one part does not have is filled with `none`.
template <class Value>
void append(std::vector<Value>& whole, std::size_t rows, const std::vector<Value>& part, std::size_t part_rows,
            Value none) {
    if (whole.empty() && part.empty()) return;
    whole.resize(rows, none);
    whole.insert(whole.end(), part.begin(), part.end());
    whole.resize(rows + part_rows, none);
}

/// Appends the modes, whose words may have other indices in the other part.
void append_modes(TaggedLoop& whole, const TaggedLoop& part) {
    std::vector<std::uint8_t> modes;
    for (const std::uint8_t mode : part.mode) {
        const std::string& word = part.mode_words[mode];
        if (whole.mode_words.empty()) whole.mode_words.emplace_back();
        auto found = std::ranges::find(whole.mode_words, word);
        if (found == whole.mode_words.end() && whole.mode_words.size() <= std::numeric_limits<std::uint8_t>::max())
            found = whole.mode_words.insert(found, word);
        const bool known = found != whole.mode_words.end();
        modes.push_back(known ? static_cast<std::uint8_t>(found - whole.mode_words.begin()) : std::uint8_t{0});
    }
    append(whole.mode, whole.t.size(), modes, part.t.size(), std::uint8_t{0});
}

/// The values of a tag with its times moved by `later`; empty without a tag.
TagValues values_of(const TaggedLoop* tag, double later) {
    TagValues out;
    if (tag == nullptr) return out;
    out = {tag->t, tag->y};
    for (double& t : out.t) t += later;
    return out;
}

/// A loop from its tags, by role; null if a role has none. `seconds`: of a unit of their times, 0 if not known.
TaggedLoop loop_of_tags(const std::string& name, const std::array<const TaggedLoop*, kRoleCount>& tags,
                        double seconds) {
    TaggedLoop out;
    out.tag = name;
    const TaggedLoop &y = *tags[kOutputRole], &u = *tags[kInputRole];
    out.epoch = y.epoch;
    out.utc = y.utc;
    std::array<double, kRoleCount> later{};
    std::vector<std::string> names;
    for (std::size_t role = 0; role < tags.size(); ++role) {
        if (tags[role] == nullptr) continue;
        const TaggedLoop& tag = *tags[role];
        if (tag.fault) return set_fault(out, *tag.fault), out;
        if (tag.epoch.has_value() != y.epoch.has_value())
            return set_fault(out, "Only one of " + y.tag + " and " + tag.tag +
                                      " has dates, so their times cannot be compared. Export both with dates."),
                   out;
        if (tag.epoch && seconds > 0) later[role] = (*tag.epoch - *y.epoch) / seconds;
        names.push_back(tag.tag);
        if (role == kOutputRole || role == kInputRole) out.bad += tag.bad;
        out.notes.insert(out.notes.end(), tag.notes.begin(), tag.notes.end());
    }
    out.notes.push_back("The tags " + listed(names, "and") + " were put together; each has a file of its own.");
    const TagValues ys = values_of(&y, 0), us = values_of(&u, later[kInputRole]);
    if (auto apart = apart_sentence(ys, y.tag, us, u.tag); !apart.empty()) return set_fault(out, std::move(apart)), out;
    TagModes mode;
    if (const TaggedLoop* tag = tags[kModeRole]; tag != nullptr && !tag->mode.empty()) {
        mode = {tag->t, tag->mode};
        for (double& t : mode.t) t += later[kModeRole];
        out.mode_words = tag->mode_words;
    }
    join_tags(ys, us, values_of(tags[kReferenceRole], later[kReferenceRole]), mode, out);
    refuse_empty(out, y.tag, u.tag);
    return out;
}

Problem no_loop(std::size_t files) {
    if (files == 0)
        return unreadable_loops("There is no file with records: send at least one, in a form as the part file.");
    return unreadable_loops(
        "No loop was found: a loop needs a measurement and a controller output, such as the files FIC101.PV.csv and "
        "FIC101.OP.csv, or the columns FIC101.PV and FIC101.OP.");
}

}  // namespace

void JoinedLoops::add(const std::string& file, LoopsReader& reader) {
    ++files_;
    TaggedLoop loop;
    while (reader.next(loop)) {
        numbers_ += numbers_of(loop);
        Parts& parts = loop.only_tag ? tags_ : parts_;
        add(parts, file, std::move(loop));
    }
    for (const std::string& note : reader.notes()) notes_.emplace_back(file, note);
}

void JoinedLoops::add(Parts& parts, const std::string& file, TaggedLoop loop) {
    const auto [found, fresh] = parts.try_emplace(lower_case(loop.tag));
    if (fresh)
        found->second = {file, std::move(loop)};
    else
        join(found->second, file, std::move(loop));
}

void JoinedLoops::add_unreadable(const std::string& file, Problem problem) {
    ++files_;
    TaggedLoop loop;
    loop.tag = file;
    loop.fault = problem.detail;
    parts_.try_emplace(lower_case(file), Part{file, std::move(loop)});
    unreadable_ = std::move(problem);
}

void JoinedLoops::join(Part& part, const std::string& file, TaggedLoop loop) {
    TaggedLoop& whole = part.loop;
    if (whole.fault && !loop.fault)
        std::swap(whole, loop), whole.notes.push_back(part.file + " was left out: " + *loop.fault);
    else if (loop.fault && !whole.fault)
        whole.notes.push_back(file + " was left out: " + *loop.fault);
    if (whole.fault || loop.fault) return;
    if (!whole.epoch || !loop.epoch || !(seconds_ > 0))
        return set_fault(whole, whole.tag + " is in " + part.file + " and in " + file +
                                    ", and without dates in both the order is not known. Export with dates, or rename "
                                    "the tag in one of them.");
    const double later = (*loop.epoch - *whole.epoch) / seconds_;
    append_modes(whole, loop);
    append(whole.r, whole.t.size(), loop.r, loop.t.size(), kNoNumber);
    for (const double t : loop.t) whole.t.push_back(t + later);
    whole.y.insert(whole.y.end(), loop.y.begin(), loop.y.end());
    whole.u.insert(whole.u.end(), loop.u.begin(), loop.u.end());
    whole.bad += loop.bad;
    whole.notes.insert(whole.notes.end(), loop.notes.begin(), loop.notes.end());
    ++part.files;
}

void JoinedLoops::join_tags_of_files() {
    std::vector<std::string> names;
    std::vector<const Part*> parts;
    for (auto& [key, part] : tags_) {
        put_rows_in_order(part.loop);
        names.push_back(part.loop.tag);
        parts.push_back(&part);
    }
    const GroupedTags groups = group_tags(names);
    if (std::string note = partial_note(groups.partial); !note.empty()) notes_.emplace_back("", std::move(note));
    for (const LoopTags& group : groups.loops) {
        std::array<const TaggedLoop*, kRoleCount> tags{};
        for (std::size_t role = 0; role < tags.size(); ++role)
            if (group.at[role]) tags[role] = &parts[*group.at[role]]->loop;
        TaggedLoop loop = loop_of_tags(group.name, tags, seconds_);
        if (!group.fault.empty()) set_fault(loop, group.fault);
        add(parts_, parts[*group.at[kOutputRole]]->file, std::move(loop));
    }
    tags_.clear();
}

std::optional<Problem> JoinedLoops::finish() {
    if (files_ == 1 && unreadable_) return unreadable_;
    join_tags_of_files();
    if (parts_.empty()) return no_loop(files_);
    return std::nullopt;
}

bool JoinedLoops::next(TaggedLoop& loop) {
    if (parts_.empty()) return false;
    Part part = std::move(parts_.extract(parts_.begin()).mapped());
    if (part.files > 1) {
        put_rows_in_order(part.loop);
        hold(part.loop.r);
        part.loop.notes.push_back("Its parts in " + std::to_string(part.files) + " files were joined by their dates.");
    }
    loop = std::move(part.loop);
    return true;
}

std::vector<std::string> JoinedLoops::notes() const {
    std::vector<std::string> out;
    for (const auto& [file, note] : notes_) out.push_back(files_ > 1 && !file.empty() ? file + ": " + note : note);
    return out;
}

}  // namespace tunewright::api
