/* Codes of transfer matrices: what they lose, what they refuse, and the product.
 *
 * Why this is hard: the same matrix is packed in five ways whose errors are allowed, so that a wrong lane, shift or base may
 * hide behind them. Strategy: bounds for each entry that follow from the code's step, exact cases (zeros, equal entries, powers
 * of two), the product against the decoded rows bit for bit where the order is known, and every word of small codes forged. */
#include "radiosity/codec_parts.h"
#include "transfer_lab.h"

static const char *const names[] = {
#define X(macro, name, what) name,
    VIT_TRANSFERS(X)
#undef X
};

static coded encode(const transfer_lab *l, const transfer_matrix *m, uint32_t codec, double keep, uint32_t rank,
                    unsigned threads) {
    coded c;
    vit_text why = {""};
    const codec_input in = {.matrix = m, .area = l->area, .codec = codec, .keep = keep, .rank = rank, .threads = threads};
    if (codec_encode(&in, &c, &why) != VIT_OK || vit_transfer_check(c.words, c.count, &why) != VIT_OK)
        fail_msg("%s: %s", names[codec], why.text);
    return c;
}

/* How far an entry may be off, of the largest in its row; 0: exactly right. */
static double allowed(uint32_t codec, double entry, double most) {
    switch (codec) {
    case VIT_TRANSFER_FLOAT32:
        return 0.0;
    case VIT_TRANSFER_FLOAT16:
        return entry * 0x1p-12 + most * 0x1p-32;
    case VIT_TRANSFER_LOG8: /* 24 octaves in 255 steps at most */
        return entry * 0.05 + most * 0x1p-6;
    default:
        return most;
    }
}

static void every_code_is_as_near_as_its_steps(void **state) {
    static const uint32_t sizes[] = {1, 3, 5, 16, 47, 300};
    (void)state;
    for (size_t s = 0; s < 6; s++) {
        const uint32_t n = sizes[s];
        transfer_lab l = transfer_lab_open(n, factor_room);
        transfer_matrix m = transfer_lab_matrix(&l, 3, 0);
        float *row = transfer_array(n, sizeof *row);
        for (uint32_t codec = 0; codec < VIT_TRANSFER_COUNT; codec++) {
            coded c = encode(&l, &m, codec, -1.0, 16, 0);
            for (uint32_t i = 0; i < n; i++)
                for (uint32_t k = 0; k < 3; k++) {
                    const float *right = m.s[k] + (size_t)i * n;
                    double most = 0.0;
                    for (uint32_t j = 0; j < (codec < VIT_TRANSFER_BC1 ? n : n * n); j++) { /* of the row, or of all */
                        const double entry = (double)(codec < VIT_TRANSFER_BC1 ? right : m.s[k])[j];
                        most = entry > most ? entry : most;
                    }
                    codec_row(c.words, i, k, row);
                    for (uint32_t j = 0; j < n; j++)
                        if (fabs((double)row[j] - (double)right[j]) > allowed(codec, (double)right[j], most) * (1 + 1e-6))
                            fail_msg("%s, %u patches: entry %u, %u is %g instead of %g", names[codec], n, i, j, (double)row[j],
                                     (double)right[j]);
                }
            coded_free(&c);
        }
        free(row);
        transfer_matrix_free(&m);
        transfer_lab_close(&l);
    }
}

static void zeros_stay_zeros(void **state) {
    transfer_lab l = transfer_lab_open(60, factor_room);
    transfer_matrix m = transfer_lab_matrix(&l, 3, 0), black;
    float row[60];
    (void)state;
    for (uint32_t codec = 0; codec < VIT_TRANSFER_SPARSE_LOW_RANK; codec++) {
        coded c = encode(&l, &m, codec, -1.0, 0, 0);
        for (uint32_t i = 5; i < 60; i += 11) { /* sees nobody */
            codec_row(c.words, i, 0, row);
            for (uint32_t j = 0; j < 60 && codec != VIT_TRANSFER_BC1; j++)
                assert_true(row[j] == 0.0f);
        }
        coded_free(&c);
    }
    transfer_lab_paint(&l, 0.0f);
    black = transfer_lab_matrix(&l, 3, 0);
    for (uint32_t codec = 0; codec < VIT_TRANSFER_COUNT; codec++) {
        coded c = encode(&l, &black, codec, -1.0, 0, 0);
        for (uint32_t i = 0; i < 60; i++) {
            codec_row(c.words, i, i % 3, row);
            for (uint32_t j = 0; j < 60; j++)
                assert_true(row[j] == 0.0f);
        }
        coded_free(&c);
    }
    transfer_matrix_free(&black);
    transfer_matrix_free(&m);
    transfer_lab_close(&l);
}

/* Blocks of one colour, and a matrix of rank 1. */
static void equal_entries_are_exact_but_for_a_step(void **state) {
    static const double steps[VIT_TRANSFER_COUNT] = {0.0, 0x1p-12, 1e-6, 0.01, 1e-3};
    transfer_lab l = transfer_lab_open(33, factor_even);
    transfer_lab_paint(&l, 0.5f);
    transfer_matrix m = transfer_lab_matrix(&l, 3, 0);
    float row[33];
    (void)state;
    for (uint32_t codec = 0; codec < VIT_TRANSFER_COUNT; codec++) {
        coded c = encode(&l, &m, codec, 0.0, 16, 0);
        for (uint32_t i = 0; i < 33; i++) {
            codec_row(c.words, i, i % 3, row);
            for (uint32_t j = 0; j < 33; j++) {
                const double right = (double)m.s[i % 3][i * 33 + j];
                if (fabs((double)row[j] - right) > steps[codec] * right)
                    fail_msg("%s: %.9g instead of %.9g", names[codec], (double)row[j], right);
            }
        }
        coded_free(&c);
    }
    transfer_matrix_free(&m);
    transfer_lab_close(&l);
}

static void kept_entries_are_exact_and_as_many_as_asked_for(void **state) {
    enum { N = 64 };
    transfer_lab l = transfer_lab_open(N, factor_room);
    transfer_matrix m = transfer_lab_matrix(&l, 3, 0);
    kept_entries entries;
    float row[N];
    (void)state;
    const codec_input in = {.matrix = &m, .area = l.area, .codec = VIT_TRANSFER_BC1};
    assert_true(codec_choose(&in, 0.25, &entries));
    uint32_t kept = 0;
    coded c = encode(&l, &m, VIT_TRANSFER_BC1, 0.25, 0, 0);
    for (uint32_t i = 0; i < N; i++)
        for (uint32_t k = 0; k < 3; k++) {
            codec_row(c.words, i, k, row);
            for (uint32_t j = 0; j < N; j++) {
                const double right = (double)m.s[k][i * N + j];
                kept += entries.keep[i * N + j];
                assert_true(!entries.keep[i * N + j] || fabs((double)row[j] - right) <= 1e-6 * right);
            }
        }
    assert_int_equal(kept, 3 * N * N / 4);
    kept_entries_free(&entries);
    coded_free(&c);
    transfer_matrix_free(&m);
    transfer_lab_close(&l);
}

/* More kept, or a higher rank, is nearer; with everything kept only the entries' own code is left. */
static void errors_shrink_with_what_is_kept_and_with_the_rank(void **state) {
    enum { N = 200 };
    transfer_lab l = transfer_lab_open(N, factor_room);
    transfer_matrix m = transfer_lab_matrix(&l, 3, 0);
    static float light[3 * N];
    codec_errors e[4];
    (void)state;
    for (uint32_t i = 0; i < 3 * N; i++)
        light[i] = i % 7 == 0 ? 0.0f : unit_float(pcg(i));
    static const double keep[4] = {0.0, 0.05, 0.05, 1.0};
    static const uint32_t rank[4] = {16, 16, 64, 16};
    for (int k = 0; k < 4; k++) {
        const codec_input in = {
            .matrix = &m, .area = l.area, .codec = VIT_TRANSFER_SPARSE_LOW_RANK, .keep = keep[k], .rank = rank[k]};
        coded c = encode(&l, &m, VIT_TRANSFER_SPARSE_LOW_RANK, keep[k], rank[k], 0);
        assert_int_equal(codec_judge(&in, &c, light, 1, &e[k], NULL), VIT_OK);
        coded_free(&c);
    }
    assert_true(e[1].light < e[0].light && e[2].light < e[1].light && e[3].light < e[2].light);
    assert_true(e[3].light < 1e-3 && e[3].mean < 1e-2 * e[0].mean);
    transfer_matrix_free(&m);
    transfer_lab_close(&l);
}

/* The order of operations written out again: chunks of 256 by fused multiply-add, then their sum. */
static float by_chunks(const float *row, const float *x, uint32_t n) {
    float all = 0.0f;
    for (uint32_t first = 0; first < n; first += 256) {
        float sum = 0.0f;
        for (uint32_t j = first; j < n && j < first + 256; j++)
            sum = fmaf(row[j], x[4 * j], sum);
        all += sum;
    }
    return all;
}

static void the_product_is_that_of_the_decoded_rows(void **state) {
    static const uint32_t sizes[] = {1, 3, 5, 47, 300, 530};
    (void)state;
    for (size_t s = 0; s < 6; s++) {
        const uint32_t n = sizes[s], stride = codec_stride(n);
        transfer_lab l = transfer_lab_open(n, factor_room);
        transfer_matrix m = transfer_lab_matrix(&l, 3, 0);
        float *x = transfer_array(4 * stride, sizeof *x), *y = transfer_array(3 * stride, sizeof *y),
              *row = transfer_array(n, sizeof *row);
        for (uint32_t i = 0; i < 4 * n; i++)
            x[i] = i % 4 < 3 ? 10.0f * unit_float(pcg(i)) : NAN; /* the fourth is not looked at */
        for (uint32_t codec = 0; codec < VIT_TRANSFER_COUNT; codec++) {
            coded c = encode(&l, &m, codec, -1.0, 16, 0);
            assert_int_equal(codec_product(c.words, x, y, 1, NULL), VIT_OK);
            for (uint32_t k = 0; k < 3; k++)
                for (uint32_t i = 0; i < stride; i++) {
                    double right = 0.0, size = 0.0;
                    const float found = y[k * stride + i];
                    if (i < n)
                        codec_row(c.words, i, k, row);
                    for (uint32_t j = 0; i < n && j < n; j++) {
                        right += (double)row[j] * (double)x[4 * j + k];
                        size += fabs((double)row[j] * (double)x[4 * j + k]);
                    }
                    const bool exact = codec < VIT_TRANSFER_BC1 || i >= n;
                    if (exact ? found != (i < n ? by_chunks(row, x + k, n) : 0.0f)
                              : fabs((double)found - right) > 2e-5 * size + 1e-5)
                        fail_msg("%s, %u patches: %.9g instead of %.9g", names[codec], n, (double)found, right);
                }
            coded_free(&c);
        }
        free(x);
        free(y);
        free(row);
        transfer_matrix_free(&m);
        transfer_lab_close(&l);
    }
}

static void threads_change_no_byte(void **state) {
    transfer_lab l = transfer_lab_open(200, factor_room);
    transfer_matrix m = transfer_lab_matrix(&l, 3, 0);
    static float x[4 * 208], one[3 * 208], two[3 * 208];
    (void)state;
    for (uint32_t i = 0; i < 4 * 200; i++)
        x[i] = unit_float(pcg(i));
    for (uint32_t codec = 0; codec < VIT_TRANSFER_COUNT; codec++) {
        coded a = encode(&l, &m, codec, -1.0, 32, 1), b = encode(&l, &m, codec, -1.0, 32, 2);
        assert_int_equal(a.count, b.count);
        assert_memory_equal(a.words, b.words, a.count * sizeof *a.words);
        assert_int_equal(codec_product(a.words, x, one, 1, NULL), VIT_OK);
        assert_int_equal(codec_product(a.words, x, two, 2, NULL), VIT_OK);
        assert_memory_equal(one, two, sizeof one);
        coded_free(&a);
        coded_free(&b);
    }
    transfer_matrix_free(&m);
    transfer_lab_close(&l);
}

static void nonsense_is_refused(void **state) {
    transfer_lab l = transfer_lab_open(5, factor_even);
    transfer_matrix m = transfer_lab_matrix(&l, 3, 0), none = {0};
    coded c;
    vit_text why;
    (void)state;
    assert_int_equal(codec_encode(&(codec_input){.matrix = &m, .codec = 99}, &c, &why), VIT_BAD_INPUT);
    assert_int_equal(codec_encode(&(codec_input){.matrix = &none}, &c, &why), VIT_BAD_INPUT);
    assert_int_equal(codec_encode(&(codec_input){.matrix = &m, .rank = 7}, &c, &why), VIT_BAD_INPUT);
    assert_int_equal(codec_encode(&(codec_input){.matrix = &m, .keep = 1.5}, &c, &why), VIT_BAD_INPUT);
    none.count = 60000; /* 43 GB as floats: refused before an entry is looked at */
    assert_int_equal(codec_encode(&(codec_input){.matrix = &none}, &c, &why), VIT_BAD_INPUT);
    transfer_matrix_free(&m);
    transfer_lab_close(&l);
}

/* What is not refused is read whole: sanitizers watch. */
static void read_all(const coded *c) {
    const vit_transfer *h = header_of(c->words);
    float *x = transfer_array(4 * h->stride, sizeof *x), *y = transfer_array(3 * h->stride, sizeof *y),
          *row = transfer_array(h->patches, sizeof *row);
    assert_int_equal(codec_product(c->words, x, y, 1, NULL), VIT_OK);
    for (uint32_t i = 0; i < h->patches; i++)
        codec_row(c->words, i, i % 3, row);
    free(x);
    free(y);
    free(row);
}

/* Every word of the header and of the tables becomes something else; then words anywhere. */
static void forged_words_are_refused_or_harmless(void **state) {
    transfer_lab l = transfer_lab_open(21, factor_room);
    transfer_matrix m = transfer_lab_matrix(&l, 3, 0);
    (void)state;
    for (uint32_t codec = 0; codec < VIT_TRANSFER_COUNT; codec++) {
        coded c = encode(&l, &m, codec, 0.2, 16, 0);
        uint32_t refused = 0, tries = 0;
        for (uint32_t k = 0; k < 20000; k++) {
            const uint32_t at = k < 4 * HEADER_WORDS ? k / 4 : pcg(k) % (uint32_t)c.count, before = c.words[at];
            const uint32_t forged[4] = {before + 1, ~before, pcg(k + 1), before ^ 1u << pcg(k) % 32};
            c.words[at] = forged[k % 4];
            vit_text why = {""};
            const bool good = vit_transfer_check(c.words, c.count, &why) == VIT_OK;
            refused += !good;
            tries++;
            if (at < HEADER_WORDS && good && at != 2 && at != 7 && at != 8) /* patches in the same stride, base and step */
                fail_msg("%s: word %u of the header may be %u instead of %u", names[codec], at, forged[k % 4], before);
            if (good && k % 16 == 0)
                read_all(&c);
            assert_true(good || (why.text[0] && !strchr(why.text, '\n')));
            c.words[at] = before;
        }
        assert_true(refused >= 60 && refused < tries);
        for (size_t count = 0; count < c.count; count += count < 64 ? 1 : 97)
            assert_int_equal(vit_transfer_check(c.words, count, NULL), VIT_BAD_INPUT);
        coded_free(&c);
    }
    transfer_matrix_free(&m);
    transfer_lab_close(&l);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_code_is_as_near_as_its_steps),
        cmocka_unit_test(zeros_stay_zeros),
        cmocka_unit_test(equal_entries_are_exact_but_for_a_step),
        cmocka_unit_test(kept_entries_are_exact_and_as_many_as_asked_for),
        cmocka_unit_test(errors_shrink_with_what_is_kept_and_with_the_rank),
        cmocka_unit_test(the_product_is_that_of_the_decoded_rows),
        cmocka_unit_test(threads_change_no_byte),
        cmocka_unit_test(nonsense_is_refused),
        cmocka_unit_test(forged_words_are_refused_or_harmless),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
