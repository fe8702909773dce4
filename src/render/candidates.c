#include "render/candidates.h"

static void swap(Candidate *a, Candidate *b) {
    Candidate c = *a;
    *a = *b, *b = c;
}

void candidates_push(CandidateHeap *heap, int cell, double gain) {
    if (heap->count == MOST_CANDIDATES) return;
    int i = heap->count++;
    heap->items[i] = (Candidate){gain, cell};
    for (; i > 0 && heap->items[i].gain > heap->items[(i - 1) / 2].gain; i = (i - 1) / 2)
        swap(&heap->items[i], &heap->items[(i - 1) / 2]);
}

Candidate candidates_pop(CandidateHeap *heap) {
    Candidate *items = heap->items, top = items[0];
    items[0] = items[--heap->count];
    for (int i = 0, child; (child = 2 * i + 1) < heap->count; i = child) {
        if (child + 1 < heap->count && items[child + 1].gain > items[child].gain) child++;
        if (items[i].gain >= items[child].gain) break;
        swap(&items[i], &items[child]);
    }
    return top;
}
