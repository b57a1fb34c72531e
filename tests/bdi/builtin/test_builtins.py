"""Internal actions and functions about values, one call a line: what it answers, how it fails."""

import pytest

from bdi import Agent, parse_program, show
from bdi.model.intentions import StepFailed

BELIEFS = "p(1). p(2)[hot]. p(3). q(a,1). q(b,2). r(X) :- p(X) & X > 1."


def answers(call: str) -> list[str]:
    """The values of the variables in each answer, "X=1 Y=2"; an answer without variables is "yes"."""
    found = Agent(parse_program(BELIEFS), random_seed=7).ask(call)
    return [" ".join(f"{name}={show(value)}" for name, value in each.items()) or "yes" for each in found]


YES, NO = ["yes"], list[str]()

LISTS = [
    (".member(X,[a,b,a])", ["X=a", "X=b", "X=a"]),
    (".member(c,[a,b])", NO),
    (".member(p(X),[p(1),q,p(2)])", ["X=1", "X=2"]),
    (".length([a,b],N)", ["N=2"]),
    ('.length("abcd",N)', ["N=4"]),
    (".length([],1)", NO),
    (".empty([])", YES),
    ('.empty("")', YES),
    (".empty([a])", NO),
    (".nth(0,[a,b,c],X)", ["X=a"]),
    (".nth(I,[a,b,a],a)", ["I=0", "I=2"]),
    (".nth(I,[a,b],X)", ["I=0 X=a", "I=1 X=b"]),
    ('.nth(1,"abc",X)', ['X="b"']),
    (".concat([a],[b,c],[],L)", ["L=[a,b,c]"]),
    (".concat(X,Y,[a,b])", ["X=[] Y=[a,b]", "X=[a] Y=[b]", "X=[a,b] Y=[]"]),
    (".concat([a],Y,[a,b,c])", ["Y=[b,c]"]),
    (".concat(X,[c],[a,b,c])", ["X=[a,b]"]),
    ('.concat("a",1,b(2),[c],S)', ['S="a1b(2)[c]"']),
    ('.concat("a","b","ab")', YES),
    (".delete(a,[a,b,c,a],L)", ["L=[b,c]"]),
    (".delete(a,[a,b,c,a],[c])", NO),
    (".delete(0,[a,b,c,a],L)", ["L=[b,c,a]"]),
    (".delete(2,[1,2,3,2],L)", ["L=[1,2,2]"]),
    (".delete(9,[a],L)", ["L=[a]"]),
    (".delete(-1,[a,b],L)", ["L=[a,b]"]),
    (".delete(1,3,[a,b,c,a],L)", ["L=[a,a]"]),
    (".delete(p(_),[p(1),q,p(2)],L)", ["L=[q]"]),
    ('.delete("a","banana",S)', ['S="bnn"']),
    ('.delete(0,"banana",S)', ['S="anana"']),
    ('.delete(1,3,"banana",S)', ['S="bana"']),
    ('.delete(9,"banana",S)', ['S="banana"']),
    (".reverse([a,b,c],L)", ["L=[c,b,a]"]),
    ('.reverse("abc",S)', ['S="cba"']),
    ('.sort([c,b(1),"s",3,a,1],L)', ['L=[1,3,"s",a,b(1),c]']),
    (".sort([2,1,2],L)", ["L=[1,2,2]"]),
    (".max([1,7,3],X)", ["X=7"]),
    (".max([b,a,c(1)],X)", ["X=c(1)"]),
    (".min([4,2,3],X)", ["X=2"]),
    (".max([],X)", NO),
    (".min([],X)", NO),
    (".union([c,a],[b,a],L)", ["L=[a,b,c]"]),
    (".intersection([c,a,b],[b,a,d],L)", ["L=[a,b]"]),
    (".difference([c,a,b,c],[a],L)", ["L=[b,c]"]),
    (".prefix(X,[a,b])", ["X=[a,b]", "X=[a]", "X=[]"]),
    (".prefix([b],[a,b])", NO),
    ('.prefix("ab","abc")', YES),
    (".suffix(X,[a,b])", ["X=[a,b]", "X=[b]", "X=[]"]),
    ('.suffix("bc","abc")', YES),
    (".sublist(X,[a,b,c])", ["X=[a,b,c]", "X=[a,b]", "X=[a]", "X=[b,c]", "X=[b]", "X=[c]", "X=[]"]),
    (".sublist([a,c],[a,b,c])", NO),
    (".range(X,1,3)", ["X=1", "X=2", "X=3"]),
    (".range(X,5,1,-2)", ["X=5", "X=3", "X=1"]),
    (".range(2,1,3)", YES),
    (".range(4,1,3)", NO),
]

STRINGS = [
    ('.substring("b","aaa")', NO),
    ('.substring("a","abaca")', YES),
    ('.substring("a","abbacca",X)', ["X=0", "X=3", "X=6"]),
    ('.substring("a","bbacc",0)', NO),
    (".substring(a(10),b(t1,a(10)),X)", ["X=5"]),
    ('.substring(R,"a(10,20)",5)', ['R="20)"']),
    ('.substring(R,"a(10,20)",5,7)', ['R="20"']),
    ('.substring("bc","abcbc",S,E)', ["S=1 E=3", "S=3 E=5"]),
    ('.upper_case("aBc",S)', ['S="ABC"']),
    ('.lower_case("aBc",S)', ['S="abc"']),
    ('.replace("banana","an","AN",S)', ['S="bANANa"']),
    ('.replace("a1b22","[0-9]+","#",S)', ['S="a#b#"']),
    ('.replace("ab","(a)(b)","$2$1",S)', ['S="ba"']),
    ('.term2string(b(1,"x"),S)', ['S="b(1,"x")"']),
    ('.term2string(T,"f(1,[a])")', ["T=f(1,[a])"]),
    ('.term2string(b,"b")', YES),
    ('.term2string(b,"c")', NO),
]

FORMULAS = [
    (".findall(X,p(X),L)", ["L=[1,2,3]"]),
    (".findall(X-1,p(X),L)", ["L=[0,1,2]"]),
    (".findall(X,z(X),L)", ["L=[]"]),
    (".setof(Y,p(X) & Y = X mod 2,L)", ["L=[0,1]"]),
    (".count(p(_),N)", ["N=3"]),
    (".count(p(X) & X > 1,2)", YES),
    (".eval(X,p(1) & not p(9))", ["X=true"]),
    (".eval(X,p(9))", ["X=false"]),
    (".belief(p(X))", ["X=1", "X=2", "X=3"]),
    (".belief(p(X)[hot])", ["X=2"]),
    (".belief(r(_))", NO),
]

TYPES = [
    *[(f".{name}({term})", YES) for name, terms in {
        "atom": ["b"],
        "structure": ["b", "b(1)", "[a]", "[]"],
        "literal": ["b", "b(1)", "~b"],
        "list": ["[]", "[a]", "[a|_]"],
        "number": ["1", "-2.5", "1+1"],
        "string": ['"s"'],
        "ground": ["b(1)", '"s"'],
    }.items() for term in terms],
    *[(f".{name}({term})", NO) for name, terms in {
        "atom": ["b(1)", '"b"', "1", "_", "[]"],
        "structure": ["1", '"s"', "_"],
        "literal": ["1", '"s"', "[a]", "_"],
        "list": ["a", '"s"', "_"],
        "number": ["a", '"1"', "_"],
        "string": ["s", "1", "_"],
        "ground": ["b(_)", "_", "[a|_]"],
    }.items() for term in terms],
    (".type(b,T)", ["T=atom", "T=literal", "T=structure", "T=ground"]),
    (".type(1,T)", ["T=number", "T=ground"]),
    (".type(_,T)", ["T=free"]),
    (".type([a],T)", ["T=list", "T=structure", "T=ground"]),
    (".type({a;b},plan)", YES),
    (".type({p(X) :- q(X)},T) & T == rule", ["T=rule"]),
    ('.type("s",string)', YES),
    (".type(b(1),string)", NO),
    (".copy_term(f(A,A,b),f(1,Z,Y))", ["Z=1 Y=b"]),
    (".rename_apart(f(A,A),f(1,Z))", ["Z=1"]),
]  # fmt: skip

ANNOTATIONS = [
    (".add_annot(a,source(ann),B)", ["B=a[source(ann)]"]),
    (".add_annot(a[x],x,B)", ["B=a[x]"]),
    (".add_annot(a,source(ann),b[ann])", NO),
    (".add_annot([a,b],x,B)", ["B=[a[x],b[x]]"]),
    (".add_nested_source(a[x],ann,B)", ["B=a[x,source(ann)]"]),
    (".add_nested_source(a[source(bob)],ann,B)", ["B=a[source(ann)[source(bob)]]"]),
    (".remove_source_annot(a[source(bob),x],B)", ["B=a[x]"]),
    (".remove_source_annot([a[source(bob)],b],B)", ["B=[a,b]"]),
]

COLLECTIONS = [
    (".queue.create(Q) & .queue.head(Q,_)", NO),
    (".queue.create(Q) & .queue.remove(Q,_)", NO),
    (".queue.create(Q) & .queue.add(Q,b) & .queue.add(Q,a) & .queue.head(Q,H) & .length(Q,N)", ["Q=[b,a] H=b N=2"]),
    (".queue.create(Q,[a,b]) & .queue.remove(Q,X)", ["Q=[b] X=a"]),
    (".queue.create(Q,priority) & .queue.add(Q,d) & .queue.add_all(Q,[b,d,a])", ["Q=[a,b,d,d]"]),
    (".queue.create(Q,[a]) & .queue.copy(Q,C) & .queue.add(C,b)", ["Q=[a] C=[a,b]"]),
    (".queue.create(Q,priority) & .queue.add(Q,b) & .queue.copy(Q,C) & .queue.add(C,a)", ["Q=[b] C=[a,b]"]),
    (".queue.create(Q,[a,b]) & .queue.to_list(Q,L) & .queue.clear(Q) & .empty(Q)", ["Q=[] L=[a,b]"]),
    (".queue.create(Q,[a,b]) & .member(X,Q) & X == b", ["Q=[a,b] X=b"]),
    (".queue.create(Q) & .type(Q,queue)", ["Q=[]"]),
    (".set.create(S) & .set.add_all(S,[5,b,p(2),a]) & .set.add(S,a)", ["S={5,a,b,p(2)}"]),
    (".set.create(S,[5,b]) & .set.remove(S,b) & .set.remove(S,c)", ["S={5}"]),
    (".set.create(S,[b]) & .set.union(S,[a,1])", ["S={1,a,b}"]),
    (".set.create(S,[a,b,c]) & .set.difference(S,[a,1])", ["S={b,c}"]),
    (".set.create(S,[a,b,c]) & .set.create(V,[c,d]) & .set.intersection(S,V)", ["S={c} V={c,d}"]),
    (".set.create(S,[b,a]) & .findall(K,.member(K,S),L)", ["S={a,b} L=[a,b]"]),
    (".set.create(S,[b,a]) & .set.to_list(S,L) & .set.copy(S,C) & .set.clear(S)", ["S={} L=[a,b] C={a,b}"]),
    (".set.create(S) & .type(S,set)", ["S={}"]),
    (".map.create(M) & .map.put(M,a,1) & .map.put(M,b,2) & .map.put(M,a,3) & .length(M,N)", ["M={a->3,b->2} N=2"]),
    (".map.create(M) & .map.put(M,a,1) & .map.get(M,a,V)", ["M={a->1} V=1"]),
    (".map.create(M) & .map.get(M,c,_)", NO),
    (".map.create(M) & .map.get(M,c,V,0)", ["M={} V=0"]),
    (".map.create(M) & .map.put(M,a,1) & .map.put(M,b,2) & .findall(K,.map.key(M,K),L)", ["M={a->1,b->2} L=[a,b]"]),
    (".map.create(M) & .map.put(M,a,1) & .findall(V,.map.value(M,V),L)", ["M={a->1} L=[1]"]),
    (".map.create(M) & .map.put(M,a,1) & .map.put(M,b,2) & .findall([K,V],.map.get(M,K,V),L)",
     ["M={a->1,b->2} L=[[a,1],[b,2]]"]),
    (".map.create(M) & .map.put(M,a,1) & .map.remove(M,a,V)", ["M={} V=1"]),
    (".map.create(M) & .map.remove(M,a)", NO),
    (".map.create(M) & .map.put(M,a,1) & .map.copy(M,C) & .map.clear(M)", ["M={} C={a->1}"]),
    (".map.create(M) & .type(M,map)", ["M={}"]),
    (".map.create(M) & .map.put(M,c,1) & .map.put(M,a,2) & .findall(K,.map.key(M,K),L)", ["M={a->2,c->1} L=[a,c]"]),
    (".map.put(M,a,1) & .set.add(S,b) & .set.union(T,[c])", ["M={a->1} S={b} T={c}"]),
]  # fmt: skip

CHANCE = [
    (".shuffle([c,a,b],L) & .sort(L,[a,b,c])", 1),
    (".random(X) & X >= 0 & X < 1 & Y = 1", 1),
    (".random(X,5)", 5),
    (".random([a],X,3)", 3),
    (".random([a,b],X) & .member(X,[a,b])", 1),
    (".random([],X)", 0),
    (".range(_,1,50) & X = math.random(3) & .member(X,[0,1,2])", 50),
]

FUNCTION_VALUES = [
    ("math.abs(-3)", "3"),
    ("math.acos(1)", "0"),
    ("math.asin(0)", "0"),
    ("math.atan(0)", "0"),
    ("math.average([1,2,6])", "3"),
    ("math.mean([1,2,6])", "3"),
    ("math.ceil(1.2)", "2"),
    ("math.cos(0)", "1"),
    ("math.floor(-1.2)", "-2"),
    ("math.log(1)", "0"),
    ("math.max(1,7)", "7"),
    ("math.max([1,7,3])", "7"),
    ("math.median([5,1,3])", "3"),
    ("math.min(4,2)", "2"),
    ("math.round(2.5)", "3"),
    ("math.round(-2.5)", "-2"),
    ("math.sin(0)", "0"),
    ("math.sqrt(16)", "4"),
    ("math.std_dev([1,2,3])", "1"),
    ("math.std_dev([])", "0"),
    ("math.sum([1,2,3.5])", "6.5"),
    ("math.tan(0)", "0"),
    ("math.round(1000*math.pi)", "3142"),
    ("math.floor(math.e)", "2"),
    (".length([a,b])+1", "3"),
    (".length(\"abc\")", "3"),
    (".count(p(_))*2", "6"),
    (".count(p(X) & X > 1)", "2"),
    ("math.abs(foo)", "math.abs(foo)"),
    ("math.sqrt(-1)", "NaN"),
    ("math.acos(2)", "NaN"),
    ("math.log(0)", "-Infinity"),
    ("math.ceil(1/0)", "Infinity"),
    ("math.std_dev([3])", "NaN"),
]  # fmt: skip


@pytest.mark.parametrize(
    ("call", "expected"), [*LISTS, *STRINGS, *FORMULAS, *TYPES, *ANNOTATIONS, *COLLECTIONS], ids=str
)
def test_it_answers(call: str, expected: list[str]) -> None:
    assert answers(call) == expected


@pytest.mark.parametrize(("call", "count"), CHANCE, ids=str)
def test_it_answers_so_often(call: str, count: int) -> None:
    assert len(answers(call)) == count


@pytest.mark.parametrize(("expression", "value"), FUNCTION_VALUES, ids=str)
def test_a_function_stands_where_a_number_can(expression: str, value: str) -> None:
    assert answers(f"X = {expression}") == [f"X={value}"]


WRONG_ARGUMENTS = [
    (".member(_,X)", "argument 2 of .member is a list, set or queue, not X"),
    (".length(X,_)", "argument 1 of .length is a list, string, map, set or queue, not X"),
    (".nth(3,[a],_)", ".nth takes a place from 0 to 0, not 3"),
    (".nth(-1,[a],_)", ".nth takes a place from 0 to 0, not -1"),
    (".concat([a],X,_)", ".concat takes only lists after a list, not X"),
    (".delete(a,X,_)", ".delete takes a list, not X"),
    (".delete(1,X,[a],_)", ".delete takes a place to end at, not X"),
    ('.delete("(","a",_)', ".delete takes a regular expression"),
    (".reverse(X,_)", "argument 1 of .reverse is a list or string, not X"),
    (".range(_,1,X)", "argument 3 of .range is a whole number, not X"),
    (".range(_,1,5,0)", ".range takes a step that is not 0, not 0"),
    ('.substring(_,"abc",2,1)', ".substring takes places from 0 to 3, the start first, not 2 and 1"),
    ('.replace("a","(","b",_)', ".replace takes a regular expression"),
    ('.replace("a","a","$1",_)', ".replace takes a $ only before the number of a bracket"),
    (".set.clear(X)", "argument 1 of .set.clear is a set, not X"),
    (".map.create(M) & .set.add(M,a)", "argument 1 of .set.add is a set, not {}"),
    (".queue.create(M) & .map.put(M,a,b)", "argument 1 of .map.put is a map, not []"),
    (".queue.create(Q,fast)", ".queue.create takes the word priority, or a list, not fast"),
    (".random(a,_)", ".random takes a list, not a"),
    (".random(_,-1)", ".random takes a number of answers, not -1"),
    (".belief(X)", "argument 1 of .belief is a literal, not X"),
    (".if_then_else(p(1),{a})", ".if_then_else is a step of a plan, not a condition or a value"),
]


@pytest.mark.parametrize(("call", "message"), WRONG_ARGUMENTS, ids=str)
def test_a_value_of_the_wrong_kind_fails_with_action_place_and_value(call: str, message: str) -> None:
    with pytest.raises(StepFailed) as caught:
        answers(call)
    assert caught.value.error == "wrong_arguments"
    assert caught.value.message.startswith(message)
