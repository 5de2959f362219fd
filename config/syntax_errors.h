#pragma once

// What yaml-cpp says about a broken text, in words that tell what to do.

#include <yaml-cpp/exceptions.h>

#include <optional>
#include <string_view>

#include "config/tree_builder.h"

namespace firn::config {

// yaml-cpp takes the rest of the file for the text where a quote is not closed. The place of such a quote.
std::optional<Place> unclosed_quote(std::string_view text, const TreeBuilder& builder, const Lines& lines);

Diagnostic explain(const YAML::Exception& exception, const TreeBuilder& builder, const Lines& lines);

}  // namespace firn::config
