// One of several described types, distinguished by a word: plants by `type`, controllers by `form`.
#pragma once

#include <algorithm>
#include <variant>

#include "api/describe/description.h"

namespace tunewright::api {

/// `V` is a std::variant of the described types.
template <class V>
class Union {
public:
    /// `otherwise` is the word assumed for a missing tag; empty: the tag is required.
    Union(std::string name, std::string sentence, std::string tag, std::string otherwise = {})
        : name_(std::move(name)),
          sentence_(std::move(sentence)),
          tag_(std::move(tag)),
          otherwise_(std::move(otherwise)) {}

    /// Alternatives with the same word are tried in order: the first whose `matches` is true (empty: always) is taken.
    template <class T>
    Union& alternative(const Description<T>& description, Callable<bool(const Json&)> matches = {}) {
        const Description<T>* what = &description;
        if (words_.empty() || words_.back() != what->tag_value()) words_.push_back(what->tag_value());
        alternatives_.push_back({what->tag_value(), std::move(matches),
                                 [what](const Json& value, V& target, Reader& reader) {
                                     T content{};
                                     what->read(value, content, reader);
                                     target = std::move(content);
                                 },
                                 [what](SchemaBook& book) { return what->schema(book); }});
        writers_.push_back([what](const V& value, Writer& out) {
            if (const T* content = std::get_if<T>(&value)) what->write(*content, out);
        });
        return *this;
    }

    /// Every alternative of another union, whose variant is one of V's alternatives.
    template <class W>
    Union& include(const Union<W>& inner) {
        const Union<W>* what = &inner;
        words_.insert(words_.end(), inner.words().begin(), inner.words().end());
        const auto read_inner = [what](const Json& value, V& target, Reader& reader) {
            W content{};
            what->read(value, content, reader);
            target = std::move(content);
        };
        included_.push_back({inner.words(), read_inner, [what](SchemaBook& book) { return what->schema(book); }});
        writers_.push_back([what](const V& value, Writer& out) {
            if (const W* content = std::get_if<W>(&value)) what->write(*content, out);
        });
        return *this;
    }

    /// The words of the tag.
    const std::vector<std::string>& words() const { return words_; }

    /// A word that is planned for the contract: refused with a sentence of its own.
    Union& refuse(std::string word, std::string sentence) {
        refused_.emplace_back(std::move(word), std::move(sentence));
        return *this;
    }

    void read(const Json& value, V& target, Reader& reader) const {
        if (!value.is_object()) return reader.fault(wrong_kind(value, "an object", reader));
        const auto at = value.find(tag_);
        if (at == value.end() && otherwise_.empty()) {
            return reader.fault_at(tag_, tag_ + " is missing; it must be " + listed(words_) + ".");
        }
        const Json word = at == value.end() ? Json(otherwise_) : *at;
        const auto* const text = word.get_ptr<const std::string*>();
        if (text != nullptr) {
            for (const Alternative& alternative : alternatives_) {
                if (*text == alternative.word && (!alternative.matches || alternative.matches(value)))
                    return alternative.read(value, target, reader);
            }
            for (const Included& inner : included_) {
                if (std::find(inner.words.begin(), inner.words.end(), *text) != inner.words.end())
                    return inner.read(value, target, reader);
            }
            for (const auto& [name, sentence] : refused_) {
                if (*text == name) return reader.fault_at(tag_, sentence);
            }
        }
        const std::string meant = text != nullptr ? nearest(*text, words_) : "";
        reader.fault_at(tag_, tag_ + " is " + shown(word) + "; it must be " + listed(words_) + "." +
                                  (meant.empty() ? "" : " Did you mean " + meant + "?"));
    }

    void write(const V& value, Writer& out) const {
        for (const auto& writer : writers_) writer(value, out);
    }

    Json schema(SchemaBook& book) const {
        if (!book.components.contains(name_)) {
            book.components[name_] = nullptr;
            Json choices = Json::array();
            for (const Included& inner : included_) choices.push_back(inner.schema(book));
            for (const Alternative& alternative : alternatives_) choices.push_back(alternative.schema(book));
            book.components[name_] = {{"title", name_}, {"description", sentence_}, {"oneOf", std::move(choices)}};
        }
        return {{"$ref", "#/components/schemas/" + name_}};
    }

private:
    struct Alternative {
        std::string word;
        Callable<bool(const Json&)> matches;
        Callable<void(const Json&, V&, Reader&)> read;
        SchemaOf schema;
    };

    struct Included {
        std::vector<std::string> words;
        Callable<void(const Json&, V&, Reader&)> read;
        SchemaOf schema;
    };

    std::string name_, sentence_, tag_, otherwise_;
    std::vector<std::string> words_;
    std::vector<Alternative> alternatives_;
    std::vector<Included> included_;
    std::vector<Callable<void(const V&, Writer&)>> writers_;
    std::vector<std::pair<std::string, std::string>> refused_;
};

template <class V>
Codec<V> one_of(const Union<V>& choices) {
    const Union<V>* what = &choices;
    return {[what](const Json& value, V& target, Reader& reader) { what->read(value, target, reader); },
            [what](const V& value, Writer& out) { what->write(value, out); },
            [what](SchemaBook& book) { return what->schema(book); }};
}

}  // namespace tunewright::api
