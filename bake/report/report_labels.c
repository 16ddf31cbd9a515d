/* report_labels.c: label after label takes the cheapest of some places about its point. Greedy: a plot has a dozen labels. */
#include "report/report_parts.h"
#include "common/pi.h"

#include <math.h>

enum { DIRECTIONS = 16, RINGS = 6 };
static const double GAP = 9, RING = 13; /* pixels from the point to the nearest ring, and from ring to ring */

static report_span box(double left, double top, const report_label *l) {
    return (report_span){left, top, left + l->width, top + l->height};
}

static bool meet(report_span a, report_span b) {
    return a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1;
}

static bool within(report_span a, const report_span *outer) {
    return a.x0 >= outer->x0 && a.y0 >= outer->y0 && a.x1 <= outer->x1 && a.y1 <= outer->y1;
}

/* The box whose edge or corner that faces the point lies `distance` from it in this direction (radians, y down). */
static report_span place(const report_label *l, double direction, double distance) {
    const double dx = cos(direction), dy = sin(direction);
    const double x = l->x + dx * distance + (dx - 1) * l->width / 2, y = l->y + dy * distance + (dy - 1) * l->height / 2;
    return box(x, y, l);
}

static double price(report_span at, const report_label *labels, uint32_t placed, const report_span *avoid, uint32_t avoid_count,
                    const report_span *inside) {
    double sum = within(at, inside) ? 0 : 1e5;
    const report_span wide = {at.x0 - 3, at.y0 - 1, at.x1 + 3, at.y1 + 1};
    for (uint32_t i = 0; i < placed; i++)
        if (meet(wide, box(labels[i].left, labels[i].top, &labels[i])))
            sum += 1e4;
    for (uint32_t i = 0; i < avoid_count; i++)
        if (meet(at, avoid[i]))
            sum += 100;
    return sum;
}

void report_place_labels(report_label *labels, uint32_t count, const report_span *avoid, uint32_t avoid_count,
                         const report_span *inside) {
    for (uint32_t i = 0; i < count; i++) {
        double best = INFINITY;
        for (int ring = 0; ring < RINGS; ring++)
            for (int d = 0; d < DIRECTIONS; d++) {
                /* From down left on: there lies nothing below a front. */
                const double turn = (d + 1) / 2 * (d % 2 ? 1 : -1) * 2 * PI / DIRECTIONS;
                const report_span at = place(&labels[i], 0.75 * PI + turn, GAP + RING * ring);
                const double cost = price(at, labels, i, avoid, avoid_count, inside) + 8 * ring + fabs(turn);
                if (cost >= best)
                    continue;
                best = cost;
                labels[i].left = at.x0;
                labels[i].top = at.y0;
                labels[i].led = ring > 0;
            }
    }
}
