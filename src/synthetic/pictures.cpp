// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "synthetic/brush.h"
#include "synthetic/materials.h"
#include "synthetic/patterns.h"

namespace dxslam {
namespace {

using brush::color_of;
using brush::fractal_noise;
using brush::jitter;
using brush::random_color;

cv::Mat canvas(cv::Size size, const cv::Scalar& color) { return {size, CV_8UC3, color}; }

cv::Rect inner(const cv::Mat& image, double margin) {
  const int m = static_cast<int>(std::min(image.cols, image.rows) * margin);
  return {m, m, image.cols - 2 * m, image.rows - 2 * m};
}

void frame_around(cv::Mat& image, int width, const cv::Scalar& color) {
  cv::rectangle(image, {width / 2, width / 2},
                {image.cols - 1 - width / 2, image.rows - 1 - width / 2}, color, width);
}

cv::Rect part(const cv::Mat& image, double x, double y, double w, double h) {
  return cv::Rect(static_cast<int>(x * image.cols), static_cast<int>(y * image.rows),
                  std::max(2, static_cast<int>(w * image.cols)),
                  std::max(2, static_cast<int>(h * image.rows))) &
         cv::Rect(0, 0, image.cols, image.rows);
}

cv::Mat paint_poster(Random& random, cv::Size size) {
  cv::Mat image = canvas(size, {240, 240, 240});
  const cv::Rect all(0, 0, size.width, size.height);
  brush::fill_gradient(image, all, random_color(random, 90, 250), random_color(random, 60, 250),
                       random);
  const double split = random.uniform(0.35, 0.65);
  const int style = random.integer(4);
  const cv::Rect picture = part(image, 0.06, 0.14, 0.88, split);
  if (style == 0) brush::draw_landscape(image, picture, random);
  if (style == 1) brush::draw_skyline(image, picture, random);
  const int shapes = style < 2 ? 4 : random.integer(14, 34);
  for (int i = 0; i < shapes; ++i) {
    brush::draw_shape(image, picture, random_color(random, 20, 250), random);
  }
  const cv::Scalar ink = random.chance(0.6) ? cv::Scalar(25, 20, 20) : cv::Scalar(245, 250, 250);
  const double headline = size.height * random.uniform(0.05, 0.08);
  brush::write_word(
      image, brush::random_word(random, 5, 9),
      {static_cast<int>(size.width * 0.06), static_cast<int>(size.height * 0.04 + headline)},
      headline, ink, random);
  const double below = 0.17 + split;
  brush::write_word(
      image, brush::random_word(random, 4, 8),
      {static_cast<int>(size.width * 0.08), static_cast<int>(size.height * (below + 0.05))},
      headline * 0.8, random_color(random, 10, 120), random);
  brush::write_lines(image, part(image, 0.08, below + 0.07, 0.5, 0.88 - below), size.height * 0.035,
                     ink, random);
  for (int i = 0; i < 4; ++i) {
    brush::draw_shape(image, part(image, 0.65, below + 0.02, 0.28, 0.9 - below),
                      random_color(random, 20, 250), random);
  }
  if (random.chance(0.7)) frame_around(image, size.width / 40 + 2, random_color(random, 15, 90));
  brush::modulate(image, fractal_noise(random, size, 4, 4, 3), 0.04);
  return image;
}

cv::Mat paint_painting(Random& random, cv::Size size) {
  cv::Mat image = canvas(size, color_of(0.1, 0.4, random.uniform(50, 160)));
  brush::modulate(image, fractal_noise(random, size, 60, 60, 2), 0.2);
  const cv::Rect view = inner(image, 0.08);
  if (random.chance(0.65)) {
    brush::draw_landscape(image, view, random);
  } else {
    brush::fill_gradient(image, view, random_color(random), random_color(random), random);
    for (int i = 0; i < 40; ++i)
      brush::draw_shape(image, view, random_color(random, 20, 240), random);
  }
  cv::Mat strokes = image(view);
  brush::modulate(strokes, fractal_noise(random, view.size(), 50, 80, 2, 0.9), 0.16);
  cv::rectangle(image, view, {20, 20, 20}, 2);
  return image;
}

cv::Mat paint_spine(Random& random, cv::Size size) {
  const cv::Scalar cover = random_color(random, 35, 220);
  cv::Mat lying = canvas({size.height, size.width}, cover);  // written along, then turned
  const cv::Scalar ink =
      cover[0] + cover[1] + cover[2] > 330 ? cv::Scalar(20, 20, 25) : cv::Scalar(215, 230, 235);
  const int bands = random.integer(0, 3);
  for (int i = 0; i < bands; ++i) {
    const int at = random.integer(lying.cols), width = random.integer(2, 10);
    cv::rectangle(lying, {at, 0}, {at + width, lying.rows},
                  random.chance(0.5) ? ink : random_color(random), cv::FILLED);
  }
  const double height = std::min(lying.rows * random.uniform(0.35, 0.6), 20.0);
  const cv::Point origin(random.integer(4, 16), static_cast<int>(lying.rows / 2.0 + height / 2));
  brush::write_word(lying, brush::random_word(random, 5, 12), origin, height, ink, random);
  cv::Mat upright;
  cv::rotate(lying, upright,
             random.chance(0.8) ? cv::ROTATE_90_CLOCKWISE : cv::ROTATE_90_COUNTERCLOCKWISE);
  for (int x = 0; x < upright.cols; ++x) {  // the rounded back
    const double t = 2.0 * (x + 0.5) / upright.cols - 1.0;
    upright.col(x) *= 1.0 - 0.45 * t * t;
  }
  return upright;
}

cv::Mat paint_books(Random& random, cv::Size size) {
  cv::Mat image = canvas(size, {14, 18, 22});
  int x = 0;
  while (x < size.width) {
    if (random.chance(0.07)) {
      x += random.integer(8, 40);
      continue;
    }
    const int width = std::min(random.integer(size.height / 14, size.height / 5), size.width - x);
    const int height = static_cast<int>(size.height * random.uniform(0.6, 0.97));
    if (width >= 6) {
      paint_spine(random, {width, height})
          .copyTo(image(cv::Rect(x, size.height - height, width, height)));
      cv::line(image, {x, size.height - height}, {x, size.height}, {10, 10, 10}, 1);
    }
    x += width;
  }
  return image;
}

cv::Mat paint_screen(Random& random, cv::Size size) {
  cv::Mat image = canvas(size, color_of(random.uniform(), 0.4, random.uniform(40, 130)));
  if (random.chance(0.5)) brush::draw_landscape(image, {0, 0, size.width, size.height}, random);
  const int windows = random.integer(2, 4);
  for (int i = 0; i < windows; ++i) {
    const cv::Rect area = part(image, random.uniform(0.02, 0.4), random.uniform(0.02, 0.4),
                               random.uniform(0.35, 0.6), random.uniform(0.35, 0.6));
    const bool dark = random.chance(0.4);
    cv::rectangle(image, area, dark ? cv::Scalar(40, 34, 30) : cv::Scalar(245, 245, 245),
                  cv::FILLED);
    cv::rectangle(image, {area.x, area.y, area.width, std::min(area.height, size.height / 18)},
                  random_color(random, 60, 200), cv::FILLED);
    const cv::Rect text(area.x + 6, area.y + size.height / 14, area.width - 8,
                        area.height - size.height / 12);
    for (int y = text.y; y + size.height / 26 < text.br().y; y += size.height / 26) {
      const cv::Scalar ink = dark ? random_color(random, 150, 250) : random_color(random, 10, 110);
      brush::write_lines(
          image,
          {text.x + random.integer(4) * 8, y, text.width / random.integer(1, 3), size.height / 26},
          size.height / 28.0, ink, random);
    }
  }
  frame_around(image, std::max(4, size.width / 36), {25, 25, 28});
  return image;
}

// A sheet of paper, turned a little, stuck on the image.
void stick_sheet(cv::Mat& image, Random& random, cv::Point centre, cv::Size size) {
  cv::Mat sheet =
      canvas(size, random.chance(0.6) ? cv::Scalar(235, 240, 242) : random_color(random, 150, 245));
  const cv::Scalar ink = random_color(random, 10, 110);
  const int style = random.integer(3);
  if (style == 0) {
    brush::write_lines(sheet, inner(sheet, 0.1), std::max(7.0, size.height / 12.0), ink, random);
  } else if (style == 1) {
    brush::write_word(sheet, brush::random_word(random, 3, 6), {size.width / 10, size.height / 3},
                      size.height / 6.0, ink, random);
    brush::write_lines(sheet, part(sheet, 0.1, 0.45, 0.8, 0.45), std::max(7.0, size.height / 12.0),
                       ink, random);
  } else {
    for (int i = 0; i < 6; ++i)
      brush::draw_shape(sheet, inner(sheet, 0.1), random_color(random), random);
  }
  cv::rectangle(sheet, {0, 0}, {size.width - 1, size.height - 1}, cv::Scalar(120, 120, 120), 1);
  cv::Mat turn = cv::getRotationMatrix2D({size.width / 2.0F, size.height / 2.0F},
                                         random.uniform(-12, 12), 1.0);
  turn.at<double>(0, 2) += centre.x - size.width / 2.0;
  turn.at<double>(1, 2) += centre.y - size.height / 2.0;
  cv::warpAffine(sheet, image, turn, image.size(), cv::INTER_LINEAR, cv::BORDER_TRANSPARENT);
}

cv::Mat paint_notice(Random& random, cv::Size size) {
  cv::Mat image = canvas(size, color_of(0.09, 0.5, random.uniform(120, 180)));
  brush::add_noise(image, fractal_noise(random, size, size.width / 3, size.height / 3, 2, 0.8), 22);
  const int count = size.width * size.height / 9000 + 4;
  for (int i = 0; i < count; ++i) {
    const int width = random.integer(size.height / 6, size.height / 3);
    const cv::Point at(random.integer(size.width), random.integer(size.height));
    stick_sheet(image, random, at, {width, static_cast<int>(width * random.uniform(0.7, 1.4))});
    cv::circle(image, at, 3, random_color(random, 100, 250), cv::FILLED, cv::LINE_AA);
  }
  frame_around(image, size.height / 30 + 2, color_of(0.08, 0.4, 90));
  return image;
}

cv::Mat paint_papers(Random& random, cv::Size size) {
  cv::Mat image = paint_material(Pattern::kWood, random, {512, 512});
  cv::resize(image, image, size, 0, 0, cv::INTER_AREA);
  for (int i = 0; i < 9; ++i) {
    const int width = random.integer(size.height / 5, size.height / 3);
    stick_sheet(image, random, {random.integer(size.width), random.integer(size.height)},
                {width, static_cast<int>(width * random.uniform(0.8, 1.4))});
  }
  return image;
}

cv::Mat paint_door(Random& random, cv::Size size) {
  cv::Mat wood =
      paint_material(random.chance(0.6) ? Pattern::kWood : Pattern::kMetal, random, {512, 512});
  cv::Mat image;
  cv::rotate(wood, wood, cv::ROTATE_90_CLOCKWISE);
  cv::resize(wood, image, size, 0, 0, cv::INTER_AREA);
  const cv::Scalar dark = cv::mean(image) * 0.55;
  const int panels = random.integer(0, 3);
  for (int i = 0; i < panels; ++i) {
    const cv::Rect area = part(image, 0.14, 0.08 + 0.86 * i / panels, 0.72, 0.78 / panels);
    cv::rectangle(image, area, dark, 3);
    cv::rectangle(image, area + cv::Point(2, 2), cv::mean(image) * 1.25, 1);
  }
  if (random.chance(0.5)) {
    const cv::Rect glass = part(image, 0.3, 0.1, 0.4, 0.28);
    brush::draw_skyline(image, glass, random);
    cv::rectangle(image, glass, dark, 3);
  }
  frame_around(image, size.width / 24, jitter(random, dark * 1.3, 25));
  const cv::Rect plate = part(image, 0.28, 0.43, 0.44, 0.07);
  cv::rectangle(image, plate, {230, 232, 235}, cv::FILLED);
  brush::write_word(image, std::to_string(random.integer(100, 999)),
                    {plate.x + 6, plate.br().y - plate.height / 5}, plate.height * 0.6,
                    {30, 20, 20}, random);
  cv::rectangle(image, part(image, 0.84, 0.5, 0.04, 0.08), {60, 70, 75}, cv::FILLED);
  cv::rectangle(image, part(image, 0.72, 0.52, 0.15, 0.015), {190, 200, 205}, cv::FILLED);
  for (int i = 0; i < 2; ++i) {
    if (random.chance(0.6)) {
      stick_sheet(image, random,
                  {static_cast<int>(size.width * random.uniform(0.25, 0.75)),
                   static_cast<int>(size.height * random.uniform(0.55, 0.8))},
                  {size.width / 4, size.width / 3});
    }
  }
  return image;
}

cv::Mat paint_window(Random& random, cv::Size size) {
  cv::Mat image = canvas(size, {0, 0, 0});
  const cv::Rect all(0, 0, size.width, size.height);
  if (random.chance(0.5)) {
    brush::draw_skyline(image, all, random);
  } else {
    brush::draw_landscape(image, all, random);
  }
  const cv::Scalar bar(205, 212, 215), edge(120, 125, 130);
  const int width = size.width / 28 + 2;
  for (const double at : {0.0, 0.5, 1.0}) {
    const int x = static_cast<int>(at * (size.width - 1)),
              y = static_cast<int>(at * (size.height - 1));
    cv::line(image, {x, 0}, {x, size.height}, edge, width + 3);
    cv::line(image, {x, 0}, {x, size.height}, bar, width);
    if (at != 0.5) cv::line(image, {0, y}, {size.width, y}, bar, width);
  }
  return image;
}

cv::Mat paint_drawers(Random& random, cv::Size size) {
  cv::Mat image =
      paint_material(random.chance(0.5) ? Pattern::kWood : Pattern::kMetal, random, {512, 512});
  cv::resize(image, image, size, 0, 0, cv::INTER_AREA);
  const cv::Scalar dark = cv::mean(image) * 0.5;
  const int rows = random.integer(2, 4), columns = random.integer(1, 2);
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < columns; ++col) {
      const double w = 1.0 / columns, h = 1.0 / rows;
      const cv::Rect area = part(image, col * w + 0.02, row * h + 0.02, w - 0.04, h - 0.04);
      cv::Mat front = image(area);
      front *= random.uniform(0.85, 1.1);
      cv::rectangle(image, area, dark, 2);
      cv::rectangle(image, part(image, col * w + 0.35 * w, row * h + 0.2 * h, 0.3 * w, 0.06 * h),
                    {200, 205, 210}, cv::FILLED);
      cv::rectangle(image, part(image, col * w + 0.35 * w, row * h + 0.25 * h, 0.3 * w, 0.03 * h),
                    dark, cv::FILLED);
      const cv::Rect label = part(image, col * w + 0.3 * w, row * h + 0.4 * h, 0.4 * w, 0.22 * h);
      cv::rectangle(image, label,
                    random.chance(0.7) ? cv::Scalar(225, 232, 235) : random_color(random, 140, 240),
                    cv::FILLED);
      brush::write_word(image, brush::random_word(random, 3, 5),
                        {label.x + 3, label.br().y - label.height / 4}, label.height * 0.5,
                        {20, 20, 40}, random);
    }
  }
  return image;
}

cv::Mat paint_carton(Random& random, cv::Size size) {
  cv::Mat image = canvas(size, random.chance(0.65) ? color_of(0.085, 0.45, random.uniform(130, 185))
                                                   : random_color(random, 80, 220));
  brush::modulate(image, fractal_noise(random, size, 4, 40, 3, 0.8), 0.07);
  const cv::Scalar ink = jitter(random, cv::mean(image) * 0.35, 25);
  cv::rectangle(image, part(image, 0.0, 0.44, 1.0, 0.1), cv::mean(image) * 1.2, cv::FILLED);
  brush::write_word(image, brush::random_word(random, 4, 7), {size.width / 12, size.height / 3},
                    size.height * 0.13, ink, random);
  brush::write_lines(image, part(image, 0.1, 0.6, 0.45, 0.35), size.height * 0.075, ink, random);
  for (int i = 0; i < 5; ++i)
    brush::draw_shape(image, part(image, 0.6, 0.58, 0.35, 0.36),
                      random.chance(0.6) ? ink : random_color(random), random);
  frame_around(image, 2, ink);
  return image;
}

cv::Mat paint_rug(Random& random, cv::Size size) {
  const cv::Size quarter(size.width / 2, size.height / 2);
  const cv::Scalar base = random_color(random, 70, 160);
  cv::Mat corner = canvas(quarter, base), image(size, CV_8UC3);
  for (int i = 0; i < 46; ++i)
    brush::draw_shape(corner, {0, 0, quarter.width, quarter.height},
                      jitter(random, random_color(random, 40, 220), 20), random);
  for (int i = 0; i < 3; ++i) {
    const int at = quarter.width * (i + 1) / 16;
    cv::rectangle(corner, {at, at}, {2 * quarter.width, 2 * quarter.height},
                  random_color(random, 40, 220), quarter.width / 40 + 1);
  }
  cv::Mat mirrored;
  for (int k = 0; k < 4; ++k) {
    mirrored = corner;
    if (k == 1) cv::flip(corner, mirrored, 1);
    if (k == 2) cv::flip(corner, mirrored, 0);
    if (k == 3) cv::flip(corner, mirrored, -1);
    mirrored.copyTo(image(cv::Rect({(k & 1) * quarter.width, (k >> 1) * quarter.height}, quarter)));
  }
  brush::modulate(image, fractal_noise(random, size, 100, 100, 2, 0.9), 0.2);
  brush::modulate(image, fractal_noise(random, size, 5, 5, 3), 0.12);
  return image;
}

cv::Mat paint_leaves(Random& random, cv::Size size) {
  cv::Mat image = canvas(size, {12, 30, 14});
  for (int i = 0; i < 170; ++i) {
    const double light = 50 + 150.0 * i / 170;
    const cv::Scalar green = color_of(random.uniform(0.2, 0.36), random.uniform(0.4, 0.8),
                                      random.uniform(0.6, 1.1) * light);
    const cv::Point at(random.integer(size.width), random.integer(size.height));
    const double turn = random.uniform(0, 180);
    const int length = random.integer(size.width / 18, size.width / 8);
    cv::ellipse(image, at, {length, length / 3}, turn, 0, 360, green, cv::FILLED, cv::LINE_AA);
    const cv::Point along(static_cast<int>(length * std::cos(turn / 57.3)),
                          static_cast<int>(length * std::sin(turn / 57.3)));
    cv::line(image, at - along, at + along, green * 0.6, 1, cv::LINE_AA);
  }
  return image;
}

cv::Mat paint_keyboard(Random& random, cv::Size size) {
  cv::Mat image = canvas(size, {30, 30, 32});
  const int rows = 5;
  const int side = size.height / rows;
  for (int row = 0; row < rows; ++row) {
    for (int x = 2; x < size.width - 4;) {
      const int width =
          std::min(static_cast<int>(side * (random.chance(0.15) ? 1.8 : 1.0)), size.width - x - 2);
      cv::rectangle(image, {x, row * side + 2}, {x + width - 3, (row + 1) * side - 3}, {70, 70, 74},
                    cv::FILLED);
      cv::putText(image, brush::random_word(random, 1, 1), {x + 2, (row + 1) * side - 5},
                  cv::FONT_HERSHEY_SIMPLEX, 0.35, {220, 220, 220}, 1, cv::LINE_AA);
      x += width;
    }
  }
  return image;
}

cv::Mat paint_clock(Random& random, cv::Size size) {
  cv::Mat image = canvas(size, random_color(random, 30, 120));
  const cv::Point centre(size.width / 2, size.height / 2);
  const int radius = size.width * 9 / 20;
  cv::circle(image, centre, radius, {235, 238, 240}, cv::FILLED, cv::LINE_AA);
  for (int hour = 1; hour <= 12; ++hour) {
    const double angle = hour * 0.5236 - 1.5708;
    const cv::Point at(centre.x + static_cast<int>(0.8 * radius * std::cos(angle)) - 6,
                       centre.y + static_cast<int>(0.8 * radius * std::sin(angle)) + 6);
    cv::putText(image, std::to_string(hour), at, cv::FONT_HERSHEY_SIMPLEX, size.width / 300.0,
                {20, 20, 20}, 1, cv::LINE_AA);
  }
  for (const double reach : {0.5, 0.7}) {
    const double angle = random.uniform(0, 6.28);
    cv::line(image, centre,
             {centre.x + static_cast<int>(reach * radius * std::cos(angle)),
              centre.y + static_cast<int>(reach * radius * std::sin(angle))},
             {20, 20, 30}, 3, cv::LINE_AA);
  }
  return image;
}

cv::Mat paint_lamp_panel(Random& random, cv::Size size) {
  cv::Mat image = canvas(size, {250, 250, 250});
  for (int i = 1; i < 4; ++i)
    cv::line(image, {size.width * i / 4, 0}, {size.width * i / 4, size.height}, {190, 190, 190}, 2);
  brush::add_noise(image, fractal_noise(random, size, 4, 4, 2), 4);
  frame_around(image, 6, {120, 120, 120});
  return image;
}

cv::Mat paint_clothes(Random& random, cv::Size size) {
  cv::Mat image = paint_material(Pattern::kFabric, random, {512, 512});
  cv::resize(image, image, size, 0, 0, cv::INTER_AREA);
  if (random.chance(0.6)) {
    const cv::Rect print = part(image, 0.3, 0.2, 0.4, 0.35);
    for (int i = 0; i < 5; ++i)
      brush::draw_shape(image, print, random_color(random, 20, 250), random);
    brush::write_word(image, brush::random_word(random, 3, 5), {print.x, print.br().y},
                      size.height * 0.1, random_color(random, 180, 250), random);
  }
  brush::modulate(image, fractal_noise(random, size, 4, 4, 4), 0.2);  // folds
  return image;
}

cv::Mat paint_face(Random& random, cv::Size size) {
  cv::Mat image = canvas(size, color_of(0.06, random.uniform(0.3, 0.5), random.uniform(110, 215)));
  brush::modulate(image, fractal_noise(random, size, 5, 5, 4), 0.08);
  const cv::Scalar hair = color_of(0.07, random.uniform(0.2, 0.6), random.uniform(20, 120));
  cv::rectangle(image, part(image, 0, 0, 1, random.uniform(0.25, 0.4)), hair, cv::FILLED);
  cv::rectangle(image, part(image, 0, 0, 0.15, 0.7), hair, cv::FILLED);
  for (const double x : {0.35, 0.65}) {
    const cv::Point eye(static_cast<int>(x * size.width), static_cast<int>(0.5 * size.height));
    cv::ellipse(image, eye, {size.width / 12, size.height / 20}, 0, 0, 360, {240, 240, 240},
                cv::FILLED, cv::LINE_AA);
    cv::circle(image, eye, size.width / 26, {40, 30, 20}, cv::FILLED, cv::LINE_AA);
  }
  cv::line(image, {size.width / 2, size.height / 2}, {size.width / 2, size.height * 13 / 20},
           cv::mean(image) * 0.6, 2);
  cv::line(image, {size.width * 2 / 5, size.height * 4 / 5},
           {size.width * 3 / 5, size.height * 4 / 5}, {60, 50, 120}, 3);
  return image;
}

}  // namespace

cv::Mat paint_pattern(Pattern pattern, std::uint64_t seed, cv::Size size) {
  Random random(mix_seed(seed, static_cast<std::uint64_t>(pattern)));
  switch (pattern) {
    case Pattern::kPoster:
      return paint_poster(random, size);
    case Pattern::kPainting:
      return paint_painting(random, size);
    case Pattern::kBooks:
      return paint_books(random, size);
    case Pattern::kScreen:
      return paint_screen(random, size);
    case Pattern::kNotice:
      return paint_notice(random, size);
    case Pattern::kDoor:
      return paint_door(random, size);
    case Pattern::kWindow:
      return paint_window(random, size);
    case Pattern::kDrawers:
      return paint_drawers(random, size);
    case Pattern::kCarton:
      return paint_carton(random, size);
    case Pattern::kPapers:
      return paint_papers(random, size);
    case Pattern::kRug:
      return paint_rug(random, size);
    case Pattern::kLeaves:
      return paint_leaves(random, size);
    case Pattern::kKeyboard:
      return paint_keyboard(random, size);
    case Pattern::kClock:
      return paint_clock(random, size);
    case Pattern::kLampPanel:
      return paint_lamp_panel(random, size);
    case Pattern::kClothes:
      return paint_clothes(random, size);
    case Pattern::kFace:
      return paint_face(random, size);
    default:
      break;
  }
  const cv::Mat material = paint_material(pattern, random, size);
  require(!material.empty(), "pattern without a painter");
  return material;
}

}  // namespace dxslam
