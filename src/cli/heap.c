#define _DEFAULT_SOURCE /* sbrk(), madvise() */
#include "cli/heap.h"

#include <stdint.h>
#include <stdlib.h>
#ifdef __GLIBC__
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

enum { LARGE_PAGE = 1 << 21 };
/* What of the heap is in large pages; blocks that have pages of their own, and what is left free at the heap's end: as much as glibc comes
 * to by itself after blocks of this size were freed. */
enum { IN_LARGE_PAGES = 2 * LARGE_PAGE, OWN_PAGES = 2 * LARGE_PAGE, LEFT_FREE = 2 * OWN_PAGES };
/* More than the heap has at first, so that it grows. */
enum { GROWTH = 1 << 18 };

/* A large page comes only where nothing was touched before: the heap goes on a little before one, and what is written as it grows lies
 * there. What is skipped are addresses, no memory. */
void heap_begin(void) {
    const uintptr_t end = (uintptr_t)sbrk(0), page = (end + 2 * GROWTH + LARGE_PAGE - 1) / LARGE_PAGE * LARGE_PAGE;
    if (end == UINTPTR_MAX || sbrk((intptr_t)(page - 2 * GROWTH - end)) == (void *)-1) return;
    mallopt(M_MMAP_THRESHOLD, OWN_PAGES);
    mallopt(M_TRIM_THRESHOLD, LEFT_FREE);
    mallopt(M_TOP_PAD, IN_LARGE_PAGES + GROWTH);
    void *volatile growth = malloc(GROWTH); /* volatile, or no call is left */
    free(growth);
    mallopt(M_TOP_PAD, LARGE_PAGE / 16);
    if ((uintptr_t)sbrk(0) >= page + IN_LARGE_PAGES) madvise((void *)page, IN_LARGE_PAGES, MADV_HUGEPAGE);
}
#else
void heap_begin(void) {}
#endif
