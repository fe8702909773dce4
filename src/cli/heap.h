/* The program's heap. Small pictures touch most of its pages for the first time, and that takes longer than what they do there. */
#ifndef VTS_CLI_HEAP_H
#define VTS_CLI_HEAP_H

/* Has the first megabytes of the heap come in one page, where the system has pages so large: the some four hundred small ones that a small
 * picture touches take it a tenth of its time. Once, before anything large is allocated; elsewhere than with glibc nothing is done. */
void heap_begin(void);

#endif
