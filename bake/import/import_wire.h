/* import_wire.c: what the child that reads a mesh file says to its parent. Nothing of it is trusted: a reader that a file has
 * broken into may say anything. */
#ifndef VIT_BAKE_IMPORT_WIRE_H
#define VIT_BAKE_IMPORT_WIRE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct importer;

typedef struct wire {
    int fd;
    bool failed;  /* writing */
    bool ended;   /* reading: the other end has closed */
    bool refused; /* reading: what came is in order, but too much; why->text says so */
} wire;

/* What a message is: a head, then `size` bytes. */
typedef enum wire_kind { WIRE_WARNING = 1, WIRE_FAILURE, WIRE_MODEL } wire_kind;

typedef struct wire_head {
    uint64_t kind, size;
} wire_head;

void wire_send(wire *to, wire_kind kind, const void *bytes, size_t size);
/* What the importer's model holds, without its first `images` images. */
void wire_send_model(const struct importer *im, int images, wire *to);

bool wire_receive_head(wire *from, wire_head *out);
/* One line of text. */
bool wire_receive_text(wire *from, uint64_t size, char *text, size_t room);
/* Appends to the importer's model what the child read. False: it is not what a model can be, or the other end has closed. */
bool wire_receive_model(struct importer *im, uint64_t size, wire *from);

#endif
