// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/figure_file.hpp"

#include "holdfast/file_ending.hpp"
#include "holdfast/holdfast.hpp"

#ifdef HOLDFAST_RSVG
#include <cairo-pdf.h>
#include <dlfcn.h>
#include <librsvg/rsvg.h>

#include <cmath>
#include <memory>
#endif

namespace holdfast {
namespace {

bool is_drawn_by_rsvg(std::string_view path) {
  return has_ending(path, ".png") || has_ending(path, ".pdf");
}

#ifdef HOLDFAST_RSVG

/// What is called of librsvg, cairo and glib.
struct Library {
  decltype(&rsvg_handle_new_from_data) read = nullptr;
  decltype(&rsvg_handle_get_intrinsic_size_in_pixels) size = nullptr;
  decltype(&rsvg_handle_render_document) render = nullptr;
  decltype(&g_object_unref) unref = nullptr;
  decltype(&cairo_image_surface_create) image = nullptr;
  decltype(&cairo_pdf_surface_create_for_stream) pdf = nullptr;
  decltype(&cairo_surface_write_to_png_stream) write_png = nullptr;
  decltype(&cairo_surface_finish) finish = nullptr;
  decltype(&cairo_surface_status) status = nullptr;
  decltype(&cairo_surface_destroy) destroy_surface = nullptr;
  decltype(&cairo_create) begin = nullptr;
  decltype(&cairo_destroy) end = nullptr;
  bool is_there = false;
};

Library load() {
  Library library;
  // By RTLD_DEEPBIND it calls its own glib: Unicorn's library has functions of the same names.
  void* const handle = dlopen("librsvg-2.so.2", RTLD_NOW | RTLD_LOCAL | RTLD_DEEPBIND);
  if (handle == nullptr) {
    return library;
  }
  // Those of the libraries that librsvg needs are found by its handle, too.
  const auto take = [handle](const char* name, auto& function) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(handle, name));
    return function != nullptr;
  };
  library.is_there = take("rsvg_handle_new_from_data", library.read) &&
                     take("rsvg_handle_get_intrinsic_size_in_pixels", library.size) &&
                     take("rsvg_handle_render_document", library.render) &&
                     take("g_object_unref", library.unref) &&
                     take("cairo_image_surface_create", library.image) &&
                     take("cairo_pdf_surface_create_for_stream", library.pdf) &&
                     take("cairo_surface_write_to_png_stream", library.write_png) &&
                     take("cairo_surface_finish", library.finish) &&
                     take("cairo_surface_status", library.status) &&
                     take("cairo_surface_destroy", library.destroy_surface) &&
                     take("cairo_create", library.begin) && take("cairo_destroy", library.end);
  return library;
}

const Library& library() {
  static const Library kLibrary = load();
  return kLibrary;
}

cairo_status_t append(void* text, const unsigned char* bytes, unsigned int size) {
  static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(bytes), size);
  return CAIRO_STATUS_SUCCESS;
}

/// Makes a PDF of an SVG, or else a PNG; none if librsvg or cairo refuses.
std::optional<std::string> drawn(std::string_view svg, bool is_pdf) {
  const Library& rsvg = library();
  const auto* const bytes = reinterpret_cast<const guint8*>(svg.data());
  const std::unique_ptr<RsvgHandle, void (*)(gpointer)> handle(
      rsvg.read(bytes, svg.size(), nullptr), rsvg.unref);
  double width = 0;
  double height = 0;
  if (!handle || rsvg.size(handle.get(), &width, &height) == 0) {
    return std::nullopt;
  }
  std::string file;
  constexpr double kPointsPerPixel = 0.75;
  const double scale = is_pdf ? kPointsPerPixel : 1;
  const RsvgRectangle page = {.x = 0, .y = 0, .width = scale * width, .height = scale * height};
  const std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)> surface(
      is_pdf ? rsvg.pdf(&append, &file, page.width, page.height)
             : rsvg.image(CAIRO_FORMAT_ARGB32, static_cast<int>(std::lround(width)),
                          static_cast<int>(std::lround(height))),
      rsvg.destroy_surface);
  cairo_t* const context = rsvg.begin(surface.get());
  const bool is_drawn = rsvg.render(handle.get(), context, &page, nullptr) != 0;
  rsvg.end(context);
  const bool is_written = is_pdf || rsvg.write_png(surface.get(), &append, &file) == 0;
  rsvg.finish(surface.get());
  const bool is_well = rsvg.status(surface.get()) == CAIRO_STATUS_SUCCESS;
  return is_drawn && is_written && is_well ? std::optional(std::move(file)) : std::nullopt;
}

#endif

}  // namespace

std::optional<base::Error> find_figure_fault(std::string_view path) {
  if (!is_drawn_by_rsvg(path)) {
    return std::nullopt;
  }
#ifdef HOLDFAST_RSVG
  if (library().is_there) {
    return std::nullopt;
  }
  return base::bad_input(
      "PNG and PDF take librsvg 2.52 or newer (Debian: librsvg2-2), which is not installed here; "
      ".svg does without");
#else
  return base::bad_input(
      "this holdfast was built without librsvg and writes .svg only; rsvg-convert makes PNG and "
      "PDF of that");
#endif
}

std::optional<base::Error> write_figure(const std::filesystem::path& path, std::string_view svg) {
  if (auto fault = find_figure_fault(path.string())) {
    return fault;
  }
#ifdef HOLDFAST_RSVG
  if (is_drawn_by_rsvg(path.string())) {
    const auto file = drawn(svg, has_ending(path.string(), ".pdf"));
    return file ? write_file(path, *file)
                : base::Error{.code = base::ErrorCode::kUnwritable,
                              .message =
                                  "librsvg cannot draw the picture so large; --size makes "
                                  "it smaller"};
  }
#endif
  return write_file(path, svg);
}

}  // namespace holdfast
